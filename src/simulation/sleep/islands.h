// Islands: bodies that may act on each other in the next step. An island sleeps and wakes as a whole.
#pragma once

#include "collision/obstacles/environment.h"
#include "network/model/simulation_state.h"
#include "network/model/spring_network.h"

#include <utility>
#include <vector>

namespace sprung {

class Islands {
 public:
  /// Keeps references to the network and the environment. `step` in s, `gravity` in m/s^2.
  Islands(const SpringNetwork& network, const Environment& environment, double step, double gravity);

  struct Found {
    std::vector<Box3> boxes;     ///< of each body, grown by its displacement in the next step, by speed and gravity
    std::vector<Index> islands;  ///< of each body; two of one number are in one island
  };
  /// Bodies are in one island if an attachment joins them, or if their boxes overlap.
  [[nodiscard]] Found find(const SimulationState& state) const;

  /// Whether something drives each body in the step after `time` [s]: a pin or an attachment that changes then or later, or an
  /// obstacle in reach that moves then or later. Deforming obstacles reach all boxes.
  [[nodiscard]] std::vector<char> driven(const Found& found, double time) const;

  /// The time from which on no pin of the body begins, ends or moves, and no attachment of it changes [s]; infinity if there is
  /// no such time. A pin or attachment that follows an obstacle moves as long as the obstacle does.
  [[nodiscard]] double end_of_motions(std::size_t body) const { return ends_[body]; }

 private:
  void note(const Pin& pin);
  void note(const Attachment& attachment);
  [[nodiscard]] std::size_t body_of(Index particle) const;
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

/// Whether each body is in an island that contains a marked body.
[[nodiscard]] std::vector<char> with_islands(const std::vector<char>& marked, const std::vector<Index>& islands);

}  // namespace sprung
