// Impulses that a simulator records on request, for the forces of pins and of contact, and the tension of springs.
#pragma once

#include "base/types.h"

namespace sprung {

/// Sums since the last reading. Empty in a simulator that records nothing.
struct RecordedImpulses {
  Points on_pinned{};    ///< on each pinned particle, of all that acts on it but its pin, minus its gain of momentum [N s], 3 x n
  Scalars of_springs{};  ///< with which the stretch limit pulls each spring's ends together [N s]
  Points of_contact{};   ///< of contact on each particle [N s], 3 x n; recorded apart from the others

  [[nodiscard]] bool on() const { return on_pinned.cols() > 0; }
  [[nodiscard]] bool has_contact() const { return of_contact.cols() > 0; }
};

/// Adds the impulses of projections to a record. A projection that moves a particle of mass m [kg] by u [m] in a step of dt [s]
/// gives it the impulse m u / dt, as velocities follow from positions. Momentum is conserved: a pinned particle takes what its
/// pin must withstand.
class ImpulseRecorder {
 public:
  /// Records nothing.
  ImpulseRecorder() = default;
  /// Records nothing if the record is empty.
  ImpulseRecorder(RecordedImpulses& record, double dt) : record_(record.on() ? &record : nullptr), per_dt_(1.0 / dt) {}

  [[nodiscard]] bool on() const { return record_ != nullptr; }

  /// Adds the impulse on a pinned particle; `momentum` is its mass times displacement [kg m]. Requires on(). Thread-safe for
  /// different particles.
  void add_to_pinned(Index particle, const Vector3& momentum) const { record_->on_pinned.col(particle) += per_dt_ * momentum; }

  /// Adds the pull of a spring [kg m], negative for a push. Requires on(). Thread-safe for different springs.
  void add_to_spring(Index spring, double pull) const { record_->of_springs[spring] += per_dt_ * pull; }

 private:
  RecordedImpulses* record_ = nullptr;
  double per_dt_ = 0.0;
};

}  // namespace sprung
