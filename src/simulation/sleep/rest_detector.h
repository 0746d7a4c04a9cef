// Finds out which patches have come to rest, so that they can sleep.
//
// The rule is that of rigid bodies in games (Catto, Box2D; Rouwe, Jolt): what was slow for half a second is at rest. A speed is
// slow up to the one that gravity gives in a millisecond, 1 cm/s on earth. All patches are compared at the same times, the ends of
// windows of a quarter of a second.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/simulation_state.h"
#include "simulation/sleep/sleep_patch.h"

#include <array>
#include <vector>

namespace sprung {

class RestDetector {
 public:
  /// `limit` is the stretch limit, if there is one; `gravity` in m/s^2.
  RestDetector(const SpringNetwork& network, const SleepPatches& patches, const StretchLimit* limit, double gravity);

  /// Whether each patch is restless:
  /// - a free particle is farther than 2.5 mm (on earth) or a tenth of the body's shortest spring from where it was when the
  /// present
  ///   window began or, while a neighbour sleeps, when that fell asleep: slow displacements add up;
  /// - or its springs pull a neighbour that sleeps with other forces than when that fell asleep, by more than a tenth of the
  ///   neighbour's weight: friction may not hold that;
  /// - or any spring of its body misses the stretch limit by more than wanted_excess(): all of the body may have to give way.
  [[nodiscard]] std::vector<char> restless(const SimulationState& state) const;

  /// Whether a window ends at `time` [s], or the first one begins.
  [[nodiscard]] static bool window_ends(double time, const SimulationState& state);

  /// At the end of a window, sets PatchRest::rests and begins the next one. A window is quiet for a patch that is not in `restless`
  /// if the root mean square of its displacements is at most an eighth of the largest at rest, and that of its speeds is slow. A
  /// patch rests after two quiet windows, unless it moved farther in the second: what begins to slide or to fall over is slow at
  /// first. All patches of a body rest too if the same is true of the body as a whole, of which a few particles may move more.
  /// `beside` are the patches that sleep, and their neighbours.
  void end_window(double time, const std::vector<char>& restless, const std::vector<char>& beside, SimulationState& state) const;

  /// Begins all rest anew.
  static void forget(SimulationState& state);

 private:
  struct Watched {
    std::size_t body = 0;
    std::vector<Index> free;  ///< particles that are neither pinned nor asleep
    double longest = 0.0;     ///< displacement at rest [m]
  };
  /// A spring of the stretch limit with a free end.
  struct Limited {
    std::array<Index, 2> ends{};
    std::size_t body = 0;
    double longest = 0.0;  ///< [m]
  };
  /// A spring from a particle that is awake to one that sleeps.
  struct Pulling {
    Index awake = kNone;
    Index asleep = kNone;
    double stiffness = 0.0;  ///< [N/m]
  };
  [[nodiscard]] std::vector<Vector3> changes_of_pull(const SimulationState& state) const;
  [[nodiscard]] static bool has_moved(const Watched& patch, const SimulationState& state);
  void judge(const Watched& patch, bool is_restless, const SimulationState& state, PatchRest& rest) const;

  void judge_all(const std::vector<char>& restless, SimulationState& state) const;

  double slow_;                   ///< [m/s]
  std::vector<Watched> patches_;  ///< without free particles: patches that sleep or that pins hold as a whole
  std::vector<Watched> bodies_;
  std::vector<Limited> limited_;
  std::vector<Pulling> pulling_;
  std::vector<Index> patch_of_;   ///< by particle
  std::vector<double> may_pull_;  ///< change of the forces on each patch that is no reason to wake [N]
};

}  // namespace sprung
