// Which step a scene is simulated with.
#pragma once

#include "base/error.h"
#include "scene/format/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// When stability does not bound it, "auto" is at most this [s]: a fall of a second then moves a particle by 4 cm in a step. Where
/// nothing may be in the way it is a frame with implicit Euler, which is chosen for its large steps, and with a global solve that
/// keeps all that moves within its limit (see StretchLimit::follows_turn), but not with both where springs have stiffness.
inline constexpr double kLargestAutoStep = 1.0 / 240.0;

/// Steps chosen by "auto" may be made in so many parts where they miss the stretch limit, or turn too much; in more where passes
/// need that.
inline constexpr int kAutoParts = 8;

struct StepChoice {
  double step = 0.0;  ///< [s]
  int steps_per_frame = 1;
  int max_substeps = 1;                  ///< of a step, where it misses the stretch limit or turns too much
  double largest_stable = 0.0;           ///< [s]; infinity when any is stable
  std::optional<std::string> warning{};  ///< of very many steps a frame
};

/// The scene's step or, for "auto", 1 / (frame_rate * n) with the least n whose step is at most the advised one and at most what
/// the stretch limit suggests; with explicit Euler, also one at which the fastest motion grows by no more than a factor of e in the
/// whole scene. Steps of "auto" may be made in parts where a stretch limit that bears it is missed, or where what a global solve
/// holds turns too much in one, unless Verlet's `damping` takes its part of each. Where passes may give way to a global solve,
/// which holds all then, their steps are such parts of larger ones that this does with. Adds a problem when the scene's step is
/// beyond the largest stable one and `stability` is refuse, or when a frame would take too many steps; warns of very many.
[[nodiscard]] StepChoice choose_step(const Scene& scene, const SpringNetwork& network, std::vector<Problem>& problems);

}  // namespace sprung
