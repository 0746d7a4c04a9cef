// Contact stencils: two convex features of the collision mesh that may touch.
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"
#include "collision/core/contact.h"

#include <algorithm>
#include <array>
#include <optional>

namespace sprung {

/// Two sides, each the convex hull of its particles: an element, or an edge or a vertex of an element. The second side is a
/// triangle, or both sides are edges. The sides share no particle.
struct ContactStencil {
  static constexpr int kMaxParticles = 6;
  /// One value per particle of the stencil.
  template <class Value>
  using PerParticle = std::array<Value, kMaxParticles>;

  PerParticle<Index> particles{};    ///< the first side's, then the second side's
  int first_count = 0;               ///< particles of the first side, 1 to 3
  int second_count = 0;              ///< particles of the second side, 2 or 3
  Vector3 normal = Vector3::Zero();  ///< from the second side to the first side: unit length, or 0 before it is measured

  [[nodiscard]] int count() const { return first_count + second_count; }
  [[nodiscard]] bool is_vertex_face() const { return first_count == 1; }
  [[nodiscard]] bool is_edge_edge() const { return second_count == 2; }

  /// Whether the predicate is true of any of the particles.
  template <class Predicate>
  [[nodiscard]] bool any_of(const Predicate& predicate) const {
    return std::any_of(particles.begin(), particles.begin() + count(), predicate);
  }
};

template <Same<ContactStencil> S, class Visit>
void visit_members(S& s, const Visit& visit) {
  visit(s.particles, s.first_count, s.second_count, s.normal);
}

/// The particles' columns of `points`, 3 x n. Entries beyond the stencil's count are not set.
[[nodiscard]] inline ContactStencil::PerParticle<Vector3> corners_at(const ContactStencil& stencil, const Points& points) {
  ContactStencil::PerParticle<Vector3> x;
  for (std::size_t k = 0; k < static_cast<std::size_t>(stencil.count()); ++k) x[k] = points.col(stencil.particles[k]);
  return x;
}

/// Extents of the sides along a direction [m].
struct SideHeights {
  double first = 0.0;   ///< lowest height of the first side
  double second = 0.0;  ///< highest height of the second side

  [[nodiscard]] double gap() const { return first - second; }  ///< negative where the sides overlap
};

/// Requires that `height(k)` is the height of the stencil's particle k [m].
template <class Height>
[[nodiscard]] SideHeights heights_of(const ContactStencil& stencil, const Height& height) {
  SideHeights heights{height(0), height(stencil.first_count)};
  for (int k = 1; k < stencil.first_count; ++k) heights.first = std::min(heights.first, height(k));
  for (int k = stencil.first_count + 1; k < stencil.count(); ++k) heights.second = std::max(heights.second, height(k));
  return heights;
}

/// Heights along the stencil's normal at `positions` [m], 3 x n.
[[nodiscard]] inline SideHeights heights_at(const ContactStencil& stencil, const Points& positions) {
  return heights_of(stencil,
                    [&](int k) { return stencil.normal.dot(positions.col(stencil.particles[static_cast<std::size_t>(k)])); });
}

/// The closest points of the two sides.
struct ClosestFeatures {
  ContactStencil::PerParticle<double> weights{};  ///< on_first - on_second = sum_i weights_i x_i; at most 0 on the second side
  Vector3 on_first = Vector3::Zero();             ///< [m]
  Vector3 on_second = Vector3::Zero();            ///< [m]
  double squared_distance = 0.0;                  ///< [m^2]

  [[nodiscard]] Vector3 separation() const { return on_first - on_second; }
};

/// Requires the particles' positions `x` [m]. With `slack` > 0, stencils of more than four particles may get a distance that is too
/// large by a factor of up to 1 / (1 - slack): see closest_pair().
[[nodiscard]] ClosestFeatures closest_points(const ContactStencil& stencil, const ContactStencil::PerParticle<Vector3>& x,
                                             double slack = 0.0);

/// The unit vector from the second side to the first side along which their gap is largest. It is the line between the closest
/// points or, where those are too close for a reliable direction, a direction derived from the faces and edges. Sides that touch or
/// cross have no positive gap along the result.
[[nodiscard]] Vector3 separating_direction(const ContactStencil& stencil, const Points& positions);

/// The contact between the closest points at `positions` [m], 3 x n, along the line between them. Empty if the sides touch, cross
/// or are so close that rounding dominates the line, and if more than four particles have a weight (parallel sides).
[[nodiscard]] std::optional<Contact> closest_contact(const ContactStencil& stencil, const Points& positions);

}  // namespace sprung
