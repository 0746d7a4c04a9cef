// Finds out which patches have come to rest, so that they can sleep.
//
// The rule is that of rigid bodies in games (Catto, Box2D; Rouwe, Jolt): what was slow for half a second is at rest. A speed is
// slow up to the one that gravity gives in a millisecond, 1 cm/s on earth. All patches are compared at the same times, the ends of
// windows of half a second.
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
  /// - a free particle is farther than 2 mm (on earth) or a tenth of the body's shortest spring from where it was when the present
  ///   window began. While a neighbour sleeps, displacements of former windows count too, so that slow ones add up: they stretch a
  ///   patch that is 8 springs wide by 1.3 % at most;
  /// - or any spring of its body misses the stretch limit by more than the tolerance: all of the body may have to give way.
  [[nodiscard]] std::vector<char> restless(const SimulationState& state) const;

  /// After each step, at `time` [s]. `restless` patches, with those that are driven, begin anew. At the end of a window,
  /// PatchRest::rests is set of patches that were not restless if the root mean square of the displacements is at most a quarter of
  /// the largest at rest, and that of the speeds is slow and hardly grew: what begins to slide or to fall over is slow at first.
  /// `beside` are the neighbours of patches that sleep. Returns whether a window ended.
  bool note(double time, const std::vector<char>& restless, const std::vector<char>& beside, SimulationState& state) const;

  /// Before the first window, and after something that begins all rest anew.
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
  [[nodiscard]] static double displacement(const Watched& patch, const SimulationState& state);
  void begin_window(double time, SimulationState& state) const;
  void end_window(const Watched& patch, bool beside, const SimulationState& state, PatchRest& rest) const;

  double slow_;                   ///< [m/s]
  std::vector<Watched> patches_;  ///< without free particles: patches that sleep or that pins hold as a whole
  std::vector<Limited> limited_;
};

}  // namespace sprung
