// What a program decides for the steps to come.
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

struct Control {
  std::optional<Vector3> gravity{};                   ///< [m/s^2], instead of that of the settings
  std::optional<Wind> wind{};                         ///< likewise
  std::vector<std::shared_ptr<Force>> forces{};       ///< in addition to those of the model
  Constraints constraints{};                          ///< likewise
  std::vector<ContactMaterial> obstacle_materials{};  ///< instead of those of the model; empty: they hold
  std::function<bool()> stops{};                      ///< asked before each substep: true stops the step (StoppedError)

  /// Whether the program adds forces or constraints.
  [[nodiscard]] bool adds_any() const { return !forces.empty() || !constraints.empty(); }
};

}  // namespace sprung
