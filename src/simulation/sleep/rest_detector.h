// Finds out which groups have come to rest, so that they can sleep.
//
// What nobody sees move is at rest, unless it moves on steadily. All groups are compared at the same times, the ends of windows of
// a quarter of a second. The motion to come is predicted from the last three windows, as a sum of two modes that decay
// exponentially or swing (Prony 1795): each displacement is a combination of the two displacements before it.
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
  /// - A free particle has moved by more than 2.5 mm or a tenth of the body's shortest spring. The displacement counts from the
  ///   begin of the window. While a neighbour sleeps, it counts from when the neighbour fell asleep.
  /// - Its springs pull a neighbour that sleeps, and their force on the neighbour has changed by more than a tenth of the weight of
  ///   the neighbour since the neighbour fell asleep. Friction may not balance such a change.
  /// - A spring of the body misses the stretch limit by more than wanted_excess(). The limit may then need to move any group of the
  ///   body.
  [[nodiscard]] std::vector<char> restless(const SimulationState& state) const;

  /// Whether a window ends at `time` [s], or the first one begins.
  [[nodiscard]] static bool window_ends(double time, const SimulationState& state);

  /// After each step: at the end of each eighth of a window, a frame, notes the largest displacements.
  void observe(double time, SimulationState& state) const;

  /// At the end of a window, sets MotionHistory::is_at_rest and begins the next window. A group is at rest if its motion was
  /// invisible in two windows and does not go on. All groups of a body are at rest too if the body as a whole is, of which a few
  /// particles may move more. `beside` are the sleeping groups and their neighbours.
  ///
  /// Motion is invisible if the group is not in `restless`, and the root mean square over its particles is at most
  /// - 0.1 mm of the displacements in each frame of 1/32 s, whatever the frame rate of the output is, or
  /// - 0.1 mm of the displacements from the begin of the window at the end of each frame.
  /// Both bounds are smaller in bodies with springs shorter than 1 cm, in proportion.
  ///
  /// Motion goes on if the prediction slides on by more than a millimetre before it stops, or swings on, by more than 0.1 mm, at
  /// more than 0.98 of its amplitude a window. If all particles move in proportion, three windows cannot tell a swing from a slide
  /// that stops: the motion then goes on if it moved them by more than 0.1 mm in any of the three. A block that slides at a
  /// constant speed is not at rest at any speed above 30 nm/s.
  void end_window(double time, const std::vector<char>& restless, const std::vector<char>& beside, SimulationState& state) const;

  /// Discards all that is known of rest: each group has to come to rest again.
  static void forget(SimulationState& state);

 private:
  struct Watched {
    std::size_t body = 0;
    std::vector<Index> free;             ///< particles that are neither pinned nor asleep
    double shortest = 0.0;               ///< spring of the body [m]
    [[nodiscard]] double scale() const;  ///< of what nobody sees [1]
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
