// Surroundings: which patches may act on each other in the next step, and what from outside drives them.
#pragma once

#include "collision/obstacles/environment.h"
#include "network/model/simulation_state.h"
#include "simulation/sleep/sleep_patch.h"

#include <vector>

namespace sprung {

class Surroundings {
 public:
  /// Keeps references to the network, the environment and the patches. `step` in s, `gravity` in m/s^2.
  Surroundings(const SpringNetwork& network, const Environment& environment, const SleepPatches& patches, double step,
               double gravity);

  struct Found {
    std::vector<Box3> boxes;       ///< of each patch, grown by its displacement in the next step, by speed and gravity
    std::vector<PatchPair> pairs;  ///< neighbours
  };
  /// Patches are neighbours if they are adjacent, if an attachment joins them, or if their boxes overlap and they may collide.
  [[nodiscard]] Found find(const SimulationState& state) const;

  /// Whether something drives each patch in the step after `time` [s]: a pin or an attachment that changes then or later, or an
  /// obstacle in reach that moves then or later. Deforming obstacles reach all boxes.
  [[nodiscard]] std::vector<char> driven(const Found& found, double time) const;

  /// The time from which on no pin of the patch begins, ends or moves, and no attachment of it changes [s]; infinity if there is
  /// no such time. A pin or attachment that follows an obstacle moves as long as the obstacle does.
  [[nodiscard]] double end_of_motions(Index patch) const { return ends_[patch]; }

  /// Patches that attachments join, ascending.
  [[nodiscard]] const std::vector<PatchPair>& attached() const { return attached_; }

 private:
  void note(const Pin& pin);
  void note(const Attachment& attachment);
  [[nodiscard]] std::vector<Index> patches_of(const std::vector<Index>& particles) const;
  [[nodiscard]] std::vector<Index> patches_of_body(std::size_t body) const;
  [[nodiscard]] bool may_collide(const SleepPatch& a, const SleepPatch& b) const;
  [[nodiscard]] Box3 box_in_step(const SleepPatch& patch, const SimulationState& state) const;
  [[nodiscard]] bool is_reached(const Box3& box, double time) const;
  [[nodiscard]] double end_of_obstacle(Index obstacle) const;

  const SpringNetwork& network_;
  const Environment& environment_;
  const SleepPatches& patches_;
  double step_;
  double gravity_;
  std::vector<double> ends_;  ///< of the motions of each patch
  std::vector<PatchPair> attached_;
};

}  // namespace sprung
