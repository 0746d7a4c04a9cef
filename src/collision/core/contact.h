// Contacts: where the network is near an obstacle, or two of its elements are near each other. A contact may belong to a particle,
// to a point of a segment or triangle, or to the closest points of two elements; contact solvers treat all of them alike.
#pragma once

#include "base/types.h"

#include <array>
#include <limits>
#include <vector>

namespace sprung {

/// Distance that safe regions and separating planes keep beyond what is required, relative to the largest coordinate. It exceeds
/// the rounding error of a distance or of a height along a unit normal (2^-52 per operation) by far, and is well below any
/// thickness that a scene resolves.
inline constexpr double kClearance = 0x1p-30;

/// The margin of a step as a fraction of the contact gap: it keeps contacts active in a step with hardly any motion.
inline constexpr double kMarginOfGap = 0.1;

/// The margin of a step as a fraction of the largest displacement in the step.
inline constexpr double kMarginOfMotion = 0.5;

/// The margin [m] beyond the contact gap [m] within which a step detects contacts, if its forces displace the particles by up to
/// `displacement` [m]. Solver passes displace particles by less than that, so contacts farther away would stay inactive.
[[nodiscard]] constexpr double margin_of_step(double gap, double displacement) {
  return kMarginOfGap * gap + kMarginOfMotion * displacement;
}

/// A constraint on a weighted sum of particles at the end of the step, in world coordinates: normal . (sum_i weights_i x_i -
/// point) >= max(min(gap, most_gap), clearance).
///
/// Against an obstacle the sum is a point of an element: the weights are at least 0 and their sum is 1. Between elements it is the
/// point of the first minus the point of the second: the weights of the first are at least 0, those of the second at most 0, their
/// sum is 0, and `point` is 0 too.
struct Contact {
  static constexpr int kMostParticles = 4;

  std::array<Index, kMostParticles> particles{kNone, kNone, kNone, kNone};  ///< the first `count` are used, all different
  std::array<double, kMostParticles> weights{};
  int count = 0;
  Index obstacle = kNone;            ///< kNone between elements of the network
  Index patch = kNone;               ///< of the surface, where the contact was found; kNone between elements of the network
  Vector3 point = Vector3::Zero();   ///< on the obstacle's surface [m]
  Vector3 normal = Vector3::Zero();  ///< unit length, towards the free side
  Vector3 drift = Vector3::Zero();   ///< displacement of the surface by deformation in this step, without the obstacle's pose [m]
  double distance = 0.0;             ///< normal . (sum_i weights_i x_i - point) at detection [m]; negative behind the plane
  double most_gap = std::numeric_limits<double>::infinity();  ///< upper limit of the gap: for neighbours in a body [m]
  double clearance = 0.0;  ///< lower limit of the gap, whatever the thickness: above rounding [m]
};

/// New contacts of some patches with obstacles.
struct FreshContacts {
  std::vector<Index> patches{};  ///< ascending
  std::vector<Contact> contacts{};
};

/// The contact of one particle with an obstacle.
[[nodiscard]] inline Contact particle_contact(Index particle, Index obstacle, const Vector3& point, const Vector3& normal) {
  Contact contact;
  contact.particles[0] = particle;
  contact.weights[0] = 1.0;
  contact.count = 1;
  contact.obstacle = obstacle;
  contact.point = point;
  contact.normal = normal;
  return contact;
}

}  // namespace sprung
