// Gravity, wind, forces and constraints that a program sets for the next steps.
#pragma once

#include "base/contact_material.h"
#include "dynamics/air/wind.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/forces/force.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace sprung {

/// The particles that added forces and constraints move.
struct TouchedParticles {
  bool any = false;  ///< they may move any particle
  std::vector<Index> particles{};
};

struct Control {
  std::optional<Vector3> gravity{};                   ///< [m/s^2], instead of that of the settings
  std::optional<Wind> wind{};                         ///< likewise
  std::vector<std::shared_ptr<Force>> forces{};       ///< in addition to those of the model
  Constraints constraints{};                          ///< likewise
  TouchedParticles touched{};                         ///< by these forces and constraints, when they were last asked
  std::vector<ContactMaterial> obstacle_materials{};  ///< instead of those of the model; empty: those of the model
  std::function<bool()> stops{};                      ///< asked before each substep: true stops the step (StoppedError)

  /// Whether the program adds forces or constraints.
  [[nodiscard]] bool adds_any() const { return !forces.empty() || !constraints.empty(); }
};

}  // namespace sprung
