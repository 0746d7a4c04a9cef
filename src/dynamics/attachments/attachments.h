// The attachments of a simulation: when they engage, their rods and springs, and when they break.
#pragma once

#include "collision/obstacles/obstacle_set.h"
#include "dynamics/attachments/attachment_springs.h"
#include "dynamics/attachments/rods.h"
#include "dynamics/state/simulation_state.h"

#include <memory>
#include <vector>

namespace sprung {

class Attachments {
 public:
  /// Keeps references to both. Throws InputError if an attachment is to an obstacle that does not exist. `implicit`: whether the
  /// integrator solves for forces.
  Attachments(const SpringNetwork& network, const ObstacleSet& obstacles, double step_length, bool implicit);

  /// The constraint and the force, which belong to this.
  [[nodiscard]] std::shared_ptr<Rods> rods() const { return rods_; }
  [[nodiscard]] std::shared_ptr<AttachmentSprings> springs() const { return springs_; }

  /// Ends and engages attachments that are due before the next step. Returns whether anything changed: rods and springs then are
  /// those of the state.
  bool update(SimulationState& state);

  /// Makes rods and springs those of the state, at `time` [s].
  void load(const SimulationState& state, double time);

  /// Records the impulses of rods in a substep of `dt` [s] that ends at `time` [s]. A rod between particles that sleep keeps
  /// its last one. Call it before the substep is counted.
  void note_substep(double dt, double time, SimulationState& state);

  /// Breaks the links whose force is beyond the break force, after a step. Returns whether any broke: rods and springs then are
  /// without them.
  bool break_overloaded(SimulationState& state);

  /// The force of a link on its first end [N] after a step: of a rod the mean of the step.
  [[nodiscard]] Vector3 force_of(const Link& link, const SimulationState& state) const;

  /// The largest speed at which winches pull [m/s] (see kWinchTime).
  [[nodiscard]] double winch_speed(const SimulationState& state) const;

 private:
  const SpringNetwork& network_;
  const ObstacleSet& obstacles_;
  double step_length_;
  std::shared_ptr<Rods> rods_;
  std::shared_ptr<AttachmentSprings> springs_;
};

/// The time from which on the attachment does not engage, end or pull its ends together [s], with times rounded to steps.
[[nodiscard]] double end_of_changes(const Attachment& attachment, double step_length);

/// Whether attachments may do work on the bodies: they pull them to a length of their own.
[[nodiscard]] bool do_work(const std::vector<Attachment>& attachments);

}  // namespace sprung
