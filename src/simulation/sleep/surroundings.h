// Surroundings: which groups may act on each other in the next step, and what from outside drives them.
#pragma once

#include "collision/obstacles/obstacle_set.h"
#include "dynamics/state/simulation_state.h"
#include "simulation/sleep/sleep_group.h"

#include <vector>

namespace sprung {

class ObstacleFrame;

class Surroundings {
 public:
  /// Keeps references to all. `step` in s, `gravity` in m/s^2.
  Surroundings(const SpringNetwork& network, const ObstacleSet& obstacles, const SleepGroups& groups, double step,
               const Vector3& gravity);

  struct Found {
    std::vector<Box3> boxes;       ///< of each group, grown by its displacement in the next step, by speed and gravity
    std::vector<GroupPair> pairs;  ///< neighbours
  };
  /// Groups are neighbours if they are adjacent, if an attachment joins them, or if their boxes overlap and they may collide.
  [[nodiscard]] Found find(const SimulationState& state) const;

  /// Call it after the motion of a pin or an obstacle changed.
  void note_motions();

  /// Whether something drives each group in the step after `time` [s]: a pin or an attachment that changes then or later, or an
  /// obstacle in reach that moves then or later. Deforming obstacles reach all boxes.
  [[nodiscard]] std::vector<char> driven(const Found& found, double time) const;

  /// Whether an obstacle is within reach of each group at `time` [s].
  [[nodiscard]] std::vector<char> beside_obstacles(const Found& found, double time) const;

  /// The time from which on no pin of the group begins, ends or moves, and no attachment of it changes [s]; infinity if there is
  /// no such time. A pin or attachment that follows an obstacle moves as long as the obstacle does.
  [[nodiscard]] double end_of_motions(Index group) const { return ends_[group]; }

  /// Groups that attachments join, ascending.
  [[nodiscard]] const std::vector<GroupPair>& attached() const { return attached_; }

 private:
  void note(std::size_t pin);
  void note(const Attachment& attachment);
  [[nodiscard]] std::vector<Index> groups_of(const std::vector<Index>& particles) const;
  [[nodiscard]] std::vector<Index> groups_of_body(std::size_t body) const;
  [[nodiscard]] bool may_collide(const SleepGroup& a, const SleepGroup& b) const;
  [[nodiscard]] Box3 box_in_step(const SleepGroup& group, const SimulationState& state) const;
  [[nodiscard]] bool is_reached(const Box3& box, const ObstacleFrame& now) const;
  [[nodiscard]] double end_of_obstacle(Index obstacle) const;

  const SpringNetwork& network_;
  const ObstacleSet& obstacles_;
  const SleepGroups& groups_;
  double step_;
  const Vector3& gravity_;
  std::vector<double> ends_;  ///< of the motions of each group
  std::vector<GroupPair> attached_;
};

}  // namespace sprung
