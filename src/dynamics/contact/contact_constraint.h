// A contact as a constraint on positions or velocities.
#pragma once

#include "base/types.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace sprung {

/// The part of a vector across a normal of unit length.
[[nodiscard]] inline Vector3 across(const Vector3& normal, const Vector3& vector) { return vector - normal.dot(vector) * normal; }

/// A weighted sum of n particles that is constrained along a normal.
template <std::size_t n>
struct ContactConstraint {
  std::array<Index, n> particles{};
  std::array<double, n> weights{};
  std::array<double, n> shares{};  ///< change of each particle for a unit change of the sum, by inverse mass
  Index obstacle = kNone;          ///< kNone between elements of the network
  Index patch = kNone;             ///< of the surface, where the contact was found
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

  /// The same over the particles i with `counts(i)`.
  template <class Counts>
  [[nodiscard]] Vector3 sum_if(const Points& q, const Counts& counts) const {
    Vector3 result = Vector3::Zero();
    for (std::size_t k = 0; k < n; ++k) {
      if (counts(particles[k])) result += weights[k] * q.col(particles[k]);
    }
    return result;
  }

  /// Changes the sum by `change`.
  void change_sum(const Vector3& change, Points& q) const {
    for (std::size_t k = 0; k < n; ++k) q.col(particles[k]) += shares[k] * change;
  }
};

/// The goal of a constraint: normal . (sum - origin) >= least. For positions [m] the origin is where the sum would be if it moved
/// with the surface that it touches; for velocities [m/s] it is the velocity of that surface. The remaining component across the
/// normal is slip.
struct ContactGoal {
  Vector3 origin = Vector3::Zero();
  double least = 0.0;
  double touch = 0.0;                     ///< the constraint touches if it is within this distance of `least`, even without a push
  double push = 0.0;                      ///< accumulated change along the normal, >= 0
  Vector3 slip_before = Vector3::Zero();  ///< across the normal, of earlier steps; see ContactSolver
  Vector3 friction_change = Vector3::Zero();  ///< accumulated change by friction across the normal
  bool touches = false;                       ///< result of the last projection
};

/// The fraction of the slip of earlier steps that friction takes back in a step. All of it would be a stiff spring: a jelly at rest
/// would ring.
inline constexpr double kReturn = 0.1;

/// The total change that friction makes across the normal, where `needed` would leave no slip: `needed` itself while static
/// friction suffices, otherwise what kinetic friction gives (Coulomb).
template <std::size_t n>
[[nodiscard]] Vector3 friction_of(const ContactConstraint<n>& row, const ContactGoal& goal, const Vector3& needed) {
  const double length = needed.norm();
  if (length <= row.static_friction * goal.push) return needed;
  return std::min(1.0, row.friction * goal.push / length) * needed;
}

/// Projects the constraint and applies friction. The push is a Lagrange multiplier (sequential impulses): a push that another
/// contact made unnecessary is taken back, never more than was given, together with its friction. So contacts that share a load
/// may push more at first than in the end. Returns the change of the push.
template <std::size_t n>
double project_constraint(const ContactConstraint<n>& row, ContactGoal& goal, Points& q) {
  const Vector3 moved = row.sum(q) - goal.origin;
  const double along = row.normal.dot(moved);
  const double change = std::max(goal.least - along, -goal.push);
  // Most contacts stay apart; nothing is written for them. A contact that another one pushed off its surface no longer touches.
  const bool touches = goal.push + change > 0.0 || along <= goal.least + goal.touch;
  if (touches != goal.touches) goal.touches = touches;
  if (change == 0.0 && goal.push == 0.0) return 0.0;

  goal.push += change;
  Vector3 correction = change * row.normal;
  if (row.static_friction > 0.0) {
    const Vector3 slip = moved - along * row.normal;
    const Vector3 friction = friction_of(row, goal, goal.friction_change - slip - kReturn * goal.slip_before);
    correction += friction - goal.friction_change;
    goal.friction_change = friction;
  }
  row.change_sum(correction, q);
  return change;
}

}  // namespace sprung
