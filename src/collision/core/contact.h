// Where the network comes near an obstacle, or two of its elements come near each other: a particle, a point of a segment or
// triangle, or the two nearest points of a pair of elements are all the same to those who answer.
#pragma once

#include "base/types.h"

#include <array>
#include <limits>
#include <vector>

namespace sprung {

/// A plane below which a weighted sum of particles may not fall, in the world at the end of the step:
/// normal . (sum_i weights_i x_i - point) >= max(min(gap, most_gap), clearance).
///
/// Against an obstacle the sum is a point of an element: the weights are at least 0 and their sum is 1. Between elements it is the
/// point of one minus the point of the other: the weights of the one are at least 0, those of the other at most 0, their sum is
/// 0, and so is `point`.
struct Contact {
  static constexpr int kMostParticles = 4;

  std::array<Index, kMostParticles> particles{kNone, kNone, kNone, kNone};  ///< the first `count` of them are used, all different
  std::array<double, kMostParticles> weights{};
  int count = 0;
  Index obstacle = kNone;            ///< kNone between elements of the network
  Index patch = kNone;               ///< of the surface, that it was found with; kNone between elements of the network
  Vector3 point = Vector3::Zero();   ///< on the obstacle's surface [m]
  Vector3 normal = Vector3::Zero();  ///< unit length, towards the free side
  Vector3 drift = Vector3::Zero();   ///< how far deforming has taken the surface here in this step, beside the obstacle's pose [m]
  double distance = 0.0;             ///< normal . (sum_i weights_i x_i - point) where it was found [m], negative behind the plane
  double most_gap = std::numeric_limits<double>::infinity();  ///< neighbours in a body may be nearer than its thickness [m]
  double clearance = 0.0;  ///< the least gap that is kept, whatever the thickness: above rounding [m]
};

/// Contacts of some patches with obstacles, found anew.
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
