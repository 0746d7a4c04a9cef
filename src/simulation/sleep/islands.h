// Islands: bodies that may act on each other in the next step. An island sleeps and wakes as a whole.
#pragma once

#include "collision/obstacles/environment.h"
#include "geometry/mesh/union_find.h"
#include "network/model/simulation_state.h"
#include "network/model/spring_network.h"

#include <utility>
#include <vector>

namespace sprung {

class Islands {
 public:
  /// Keeps references to the network and the environment. `step` in s, `gravity` in m/s^2.
  Islands(const SpringNetwork& network, const Environment& environment, double step, double gravity);

  /// Whether each body may sleep in the step after `time` [s]. `calm[b]` says whether body b is at rest by itself. An island is
  /// made of bodies that an attachment joins, and of bodies whose boxes overlap, grown by their displacement in the step by speed
  /// and gravity. Its bodies sleep if all of them are calm and no moving obstacle reaches one of their boxes in the step.
  [[nodiscard]] std::vector<char> that_sleep(std::vector<char> calm, double time, const SimulationState& state) const;

  /// The time from which on no pin of the body begins, ends or moves, and no attachment of it changes [s]; infinity if there is
  /// no such time. A pin or attachment that follows an obstacle moves as long as the obstacle does.
  [[nodiscard]] double end_of_motions(std::size_t body) const { return ends_[body]; }

 private:
  void note(const Pin& pin);
  void note(const Attachment& attachment);
  [[nodiscard]] std::size_t body_of(Index particle) const;
  [[nodiscard]] UnionFind joined_by(const std::vector<Box3>& boxes) const;
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
