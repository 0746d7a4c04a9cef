// A contact as the passes of a step see it: the same for positions and for velocities.
#pragma once

#include "base/types.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace sprung {

/// A weighted sum of n particles that is held along a normal.
template <std::size_t n>
struct ContactConstraint {
  std::array<Index, n> particles{};
  std::array<double, n> weights{};
  std::array<double, n> shares{};  ///< what each particle changes by for a change of the sum by 1: by inverse mass
  Index obstacle = kNone;          ///< kNone between elements of the network
  Index patch = kNone;             ///< that it was found with
  Vector3 normal = Vector3::Zero();
  double static_friction = 0.0;
  double friction = 0.0;
  double restitution = 0.0;

  /// The weighted sum of the particles' columns of q.
  [[nodiscard]] Vector3 sum(const Points& q) const {
    Vector3 result = weights[0] * q.col(particles[0]);
    for (std::size_t k = 1; k < n; ++k) result += weights[k] * q.col(particles[k]);
    return result;
  }

  /// Changes the sum by `change`.
  void change_sum(const Vector3& change, Points& q) const {
    for (std::size_t k = 0; k < n; ++k) q.col(particles[k]) += shares[k] * change;
  }
};

/// What the sum of a row shall keep: normal . (sum - origin) >= least. Of positions [m] the origin is where the sum would be had it
/// gone along with what it meets, of velocities [m/s] the velocity of that: what is left across the normal is slip.
struct ContactGoal {
  Vector3 origin = Vector3::Zero();
  double least = 0.0;
  double touch = 0.0;              ///< within this much of its least the row touches, without being pushed too
  double push = 0.0;               ///< change along the normal so far, >= 0
  Vector3 held = Vector3::Zero();  ///< change across it by friction so far
  bool touches = false;            ///< as it was found last
};

/// What friction changes across the normal altogether, where `needed` would leave no slip: that while static friction holds it,
/// else what kinetic friction gives (Coulomb).
template <std::size_t n>
[[nodiscard]] Vector3 friction_of(const ContactConstraint<n>& row, const ContactGoal& goal, const Vector3& needed) {
  const double length = needed.norm();
  if (length <= row.static_friction * goal.push) return needed;
  return std::min(1.0, row.friction * goal.push / length) * needed;
}

/// Brings the row to its least and lets friction answer to the push. The push is a Lagrange multiplier in the sense of sequential
/// impulses: what another contact makes needless is taken back, but never more than was given, and the friction that it gave goes
/// with it: where many contacts share a load, each pushes more at first than in the end. Returns the change of the push.
template <std::size_t n>
double answer(const ContactConstraint<n>& row, ContactGoal& goal, Points& q) {
  const Vector3 moved = row.sum(q) - goal.origin;
  const double along = row.normal.dot(moved);
  const double change = std::max(goal.least - along, -goal.push);
  // Most contacts stay apart, and nothing is written for them. What another one pushed off what it meets touches no more.
  const bool touches = goal.push + change > 0.0 || along <= goal.least + goal.touch;
  if (touches != goal.touches) goal.touches = touches;
  if (change == 0.0 && goal.push == 0.0) return 0.0;

  goal.push += change;
  Vector3 answered = change * row.normal;
  if (row.static_friction > 0.0) {
    const Vector3 across = moved - along * row.normal;
    const Vector3 held = friction_of(row, goal, goal.held - across);
    answered += held - goal.held;
    goal.held = held;
  }
  row.change_sum(answered, q);
  return change;
}

}  // namespace sprung
