// Chooses the step of a scene.
#pragma once

#include "base/error.h"
#include "scene/format/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// The largest automatic step [s] if stability does not bound it: after a fall of one second, a particle moves by 4 cm in such a
/// step. If no contact is possible, a step may be as large as a frame with implicit Euler, which is made for large steps, and with
/// a global solve of all limited springs (see StretchLimit::follows_deformation); but not with implicit Euler and a stretch limit
/// if springs have stiffness.
inline constexpr double kLargestAutoStep = 1.0 / 240.0;

/// Largest number of substeps of an automatic step that misses the stretch limit or turns too much. It may be larger if passes
/// need small steps.
inline constexpr int kAutoSubsteps = 8;

struct StepChoice {
  double step = 0.0;  ///< [s]
  int steps_per_frame = 1;
  int max_substeps = 1;                  ///< of a step that misses the stretch limit or turns too much
  int inner_substeps = 1;                ///< see SimulatorSettings
  double largest_stable = 0.0;           ///< [s]; infinity if every step is stable
  std::optional<std::string> warning{};  ///< of very many steps per frame
};

/// Returns the step of the scene. An automatic step is 1 / (frame_rate * n) with the smallest n for which it is at most the
/// advised step and the step that the stretch limit suggests. With explicit Euler, the fastest motion also grows by at most a
/// factor of e in the whole scene. Automatic steps may be divided into substeps if a stretch limit that allows it is missed, or if
/// a body under a global solve turns too much in one step; not with Verlet's `damping`, which acts on each step. If bodies may be
/// handed over from passes to a global solve, the step is one that suffices for the global solve, and passes use substeps of it.
/// If passes alone need small steps and contact is possible, the step is one that suffices for contact, and passes use inner
/// substeps of it.
/// Adds a problem if the scene's step exceeds the largest stable one and `stability` is refuse, or if a frame would take too many
/// steps. Warns of very many steps. An automatic step suffices for all pins that ever hold together.
[[nodiscard]] StepChoice choose_step(const Scene& scene, const SpringNetwork& network, std::vector<Problem>& problems);

}  // namespace sprung
