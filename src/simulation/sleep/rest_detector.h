// Finds out which groups have come to rest, so that they can sleep.
//
// A group is at rest if its motion is invisible and is predicted to stop. All groups are judged at the same times, the ends of
// windows of a quarter of a second. The prediction uses the displacements in the last three windows. It takes them for a sum of two
// modes that decay exponentially or swing (Prony 1795): each displacement is then a combination of the two displacements before it.
#pragma once

#include "dynamics/state/simulation_state.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "simulation/sleep/sleep_group.h"

#include <array>
#include <vector>

namespace sprung {

class RestDetector {
 public:
  /// `limit` is the stretch limit, if there is one. Keeps a reference to `gravity` [m/s^2].
  RestDetector(const SpringNetwork& network, const SleepGroups& groups, const StretchLimit* limit, const Vector3& gravity);

  /// Whether each group is restless. One of three is true:
  /// - Since the begin of the window, a free particle has moved by more than 2.5 mm or a tenth of the body's shortest spring. While
  ///   a neighbour sleeps, this counts from when the neighbour fell asleep.
  /// - Its springs pull a neighbour that sleeps, and their force on the neighbour has changed by more than a tenth of the weight of
  ///   the neighbour since the neighbour fell asleep. Friction may not balance such a change.
  /// - A spring of the body misses the stretch limit by more than wanted_excess(). The limit may then need to move any group of the
  ///   body.
  [[nodiscard]] std::vector<char> restless(const SimulationState& state) const;

  /// Whether a window ends at `time` [s], or the first one begins.
  [[nodiscard]] static bool window_ends(double time, const SimulationState& state);

  /// Call it after each step. At the end of each of the eight frames of a window, updates the displacement in MotionHistory.
  void observe(double time, SimulationState& state) const;

  /// Call it at the end of a window. Sets MotionHistory::is_at_rest and begins the next window. A group is at rest if its motion
  /// was invisible in the last two windows and does not go on. All groups of a body are at rest too if the body as a whole is: a
  /// few of its particles may then exceed the bounds. `beside` are the sleeping groups and their neighbours.
  ///
  /// Motion is invisible if the group is not in `restless` and, in each frame of 0.039 s and 0.024 s in turn, whatever the frame
  /// rate of the output is, the root mean square of the displacements of its particles is at most 0.1 mm and none exceeds 0.3 mm,
  /// or 1 mm in a body as a whole. Both bounds are smaller in bodies with springs shorter than 1 cm, in proportion.
  ///
  /// The motion goes on if the group moved faster than 30 nm/s, and one of five is true:
  /// - The prediction is a slide of more than a millimetre, from the begin of the last window to its stop, or one that never stops.
  /// - The prediction is a swing that keeps more than 0.98 of its amplitude in a window, and the displacement in one of the three
  ///   windows exceeds 0.1 mm, or the smaller bound of short springs.
  /// - This displacement exceeds that bound, and those of the two windows before are parallel, as in a swing of all particles along
  ///   a line. Such displacements cannot tell a swing from a slide that stops.
  /// - The velocity changes steadily by more than 0.1 mm/s^2, as in a reversal by gravity.
  /// - It did not move at all in one of the two windows before, or these are not yet known.
  /// A block that slides at a constant speed above 30 nm/s is thus not at rest.
  void end_window(double time, const std::vector<char>& restless, const std::vector<char>& beside, SimulationState& state) const;

  /// Discards windows and histories: each group has to come to rest again.
  static void forget(SimulationState& state);

 private:
  struct Watched {
    std::size_t body = 0;
    std::vector<Index> free;             ///< particles that are neither pinned nor asleep
    double shortest = 0.0;               ///< length of the shortest spring of the body [m]
    [[nodiscard]] double scale() const;  ///< factor of the bounds of invisible motion, at most 1
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
    Index awake_group = kNone;
    Index asleep_group = kNone;
    double stiffness = 0.0;  ///< [N/m]
  };
  void watch(const SpringNetwork& network, const SleepGroups& groups);
  void find_pulling(const SpringNetwork& network, const std::vector<Index>& group_of);
  void find_limited(const SpringNetwork& network, const StretchLimitSettings& settings);
  [[nodiscard]] std::vector<Vector3> changes_of_pull(const SimulationState& state) const;
  [[nodiscard]] bool has_moved(const Watched& group, const SimulationState& state) const;
  [[nodiscard]] static bool goes_on(const Watched& group, const SimulationState& state, double swing);
  void judge_all(const std::vector<char>& restless, SimulationState& state) const;
  static void judge(const Watched& group, bool is_restless, const SimulationState& state, MotionHistory& history);

  const Vector3& gravity_;
  std::vector<Watched> groups_;  ///< without free particles: groups that sleep or that pins hold as a whole
  std::vector<Watched> bodies_;
  std::vector<Limited> limited_;
  std::vector<Pulling> pulling_;
  std::vector<double> masses_;  ///< of each group [kg]
};

}  // namespace sprung
