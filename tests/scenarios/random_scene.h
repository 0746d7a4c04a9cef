// Random networks thrown at random obstacles that move, rotate and deform, with random schemes, steps, sleep, springs that yield or
// break, and pins that begin and end: combinations that no other test has.
#pragma once

#include "scenarios/scenario.h"

#include <cstdint>
#include <string>

namespace sprung::testing {

/// What holds in a scene.
enum class Law : std::uint8_t {
  feasible,  ///< nothing crosses, and each vertex has an admissible position in each step
  free,      ///< nothing crosses
  reported   ///< nothing crosses before a vertex without an admissible position is reported
};

struct RandomScene {
  std::string kind;
  BuiltScene scene;
  Judge judge = Judge::obstacles_and_self;
  Law law = Law::feasible;
  bool keeps_cells = false;  ///< whether no cell of a body that preserves its volume ends inside out
};

/// The scene of this seed with a scheme. It starts without intersections. Half of the steps that are drawn beyond the largest
/// stable one stay so; the others are made smaller.
[[nodiscard]] RandomScene random_scene(std::uint64_t seed, const IntegratorSettings& integrator);

/// Whether check_step accepts the scene's scheme and step without a warning, so that the scene must not diverge.
[[nodiscard]] bool must_not_diverge(const BuiltScene& scene);

}  // namespace sprung::testing
