// Islands: bodies that may act on each other in the next step. An island sleeps and wakes as a whole.
#pragma once

#include "collision/obstacles/environment.h"
#include "network/model/simulation_state.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

class Islands {
 public:
  /// Keeps references to the network and the environment. `step` in s, `gravity` in m/s^2.
  Islands(const SpringNetwork& network, const Environment& environment, double step, double gravity);

  /// Whether each body may sleep in the step after `time` [s]. `calm[b]` says whether body b is at rest by itself. All bodies of
  /// its island must be calm: those that an attachment joins, and those whose boxes meet, grown by the way that speeds and gravity
  /// take them in the step. None of its boxes may be in reach of an obstacle that moves at that time or later.
  [[nodiscard]] std::vector<char> that_sleep(std::vector<char> calm, double time, const SimulationState& state) const;

  /// The time from which on no pin of the body begins, ends or moves, and no attachment of it changes [s]; infinity if there is
  /// none. What follows an obstacle moves as long as the obstacle does.
  [[nodiscard]] double end_of_motions(std::size_t body) const { return ends_[body]; }

 private:
  [[nodiscard]] Box3 box_in_step(const Body& body, const SimulationState& state) const;
  [[nodiscard]] bool is_reached(const Box3& box, double time) const;
  [[nodiscard]] double end_of_obstacle(Index obstacle) const;

  const SpringNetwork& network_;
  const Environment& environment_;
  double step_;
  double gravity_;
  std::vector<double> ends_;                                 ///< of the motions of each body
  std::vector<std::pair<std::size_t, std::size_t>> joined_;  ///< bodies that attachments join
};

}  // namespace sprung
