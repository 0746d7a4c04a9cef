#include "collision/pairs/contact_stencil.h"

#include "collision/safe_regions/safe_region.h"
#include "geometry/queries/closest_pair.h"

#include <cmath>
#include <span>

namespace sprung {
namespace {

using Corners = ContactStencil::PerParticle<Vector3>;

// The plane through the closest points may lose this fraction of the distance: an exact pair costs more and gains nothing.
constexpr double kSlack = 0.01;

// A smaller weight comes from rounding. Unless the sides are parallel, at most four weights are larger: one and three, or two and
// two.
constexpr double kNoWeight = 1.0e-9;

// Close to touching, rounding dominates the line between the closest points. A line is unusable if the gap along it is less than
// this fraction of the distance.
constexpr double kMinGapOfDistance = 0.5;

Simplex first_side(const ContactStencil& stencil, const Corners& x) {
  return {.x = {x[0], x[1], x[2]}, .count = stencil.first_count};
}

/// An edge is a triangle whose last two corners coincide.
TriangleCorners second_side(const ContactStencil& stencil, const Corners& x) {
  const auto first = static_cast<std::size_t>(stencil.first_count);
  return {x[first], x[first + 1], x[first + static_cast<std::size_t>(stencil.second_count) - 1]};
}

ClosestFeatures between_edges(const Corners& x) {
  const SegmentPair found = closest_points_of_segments(x[0], x[1], x[2], x[3]);
  ClosestFeatures closest;
  closest.weights = {1.0 - found.s, found.s, found.t - 1.0, -found.t};
  closest.on_first = x[0] + found.s * (x[1] - x[0]);
  closest.on_second = x[2] + found.t * (x[3] - x[2]);
  closest.squared_distance = closest.separation().squaredNorm();
  return closest;
}

ClosestFeatures between_vertex_and_face(const Corners& x) {
  const ClosestPoint found = closest_point_on_triangle(x[0], x[1], x[2], x[3]);
  const Vector3 weights = barycentric(found, x[1], x[2], x[3]);
  ClosestFeatures closest;
  closest.weights = {1.0, -weights[0], -weights[1], -weights[2]};
  closest.on_first = x[0];
  closest.on_second = found.point;
  closest.squared_distance = found.squared_distance;
  return closest;
}

ClosestFeatures between_simplices(const ContactStencil& stencil, const Corners& x, double slack) {
  const TriangleCorners second = second_side(stencil, x);
  const ClosestPair found = closest_pair(first_side(stencil, x), second, slack);
  const ClosestPoint on_second = closest_point_on_triangle(found.on_triangle, second[0], second[1], second[2]);
  const Vector3 weights = barycentric(on_second, second[0], second[1], second[2]);
  ClosestFeatures closest;
  const auto first_count = static_cast<std::size_t>(stencil.first_count);
  for (std::size_t k = 0; k < first_count; ++k) closest.weights[k] = found.weights[static_cast<Eigen::Index>(k)];
  for (std::size_t k = 0; k < 3; ++k) closest.weights[first_count + k] = -weights[static_cast<Eigen::Index>(k)];
  closest.on_first = found.on_simplex;
  closest.on_second = found.on_triangle;
  closest.squared_distance = found.squared_distance;
  return closest;
}

/// Sets weights that come from rounding to 0 and scales the others to a sum of 1 again.
void clean(std::span<double> weights) {
  double sum = 0.0;
  for (double& weight : weights) {
    if (std::abs(weight) <= kNoWeight) weight = 0.0;
    sum += std::abs(weight);
  }
  for (double& weight : weights) weight /= sum;
}

}  // namespace

ClosestFeatures closest_points(const ContactStencil& stencil, const Corners& x, double slack) {
  if (stencil.is_edge_edge()) return between_edges(x);
  if (stencil.is_vertex_face()) return between_vertex_and_face(x);
  return between_simplices(stencil, x, slack);
}

Vector3 separating_direction(const ContactStencil& stencil, const Points& positions) {
  const Corners x = corners_at(stencil, positions);
  const ClosestFeatures closest = closest_points(stencil, x, kSlack);
  ClosestPair pair;
  pair.on_simplex = closest.on_first;
  pair.on_triangle = closest.on_second;
  pair.squared_distance = closest.squared_distance;
  return separation(first_side(stencil, x), second_side(stencil, x), pair, kSlack).normal;
}

std::optional<Contact> closest_contact(const ContactStencil& stencil, const Points& positions) {
  // Coordinates relative to one of the particles lose no digits far from the origin.
  Corners x = corners_at(stencil, positions);
  const Vector3 origin = x[0];
  const auto count = static_cast<std::size_t>(stencil.count());
  for (std::size_t k = 0; k < count; ++k) x[k] -= origin;
  ClosestFeatures closest = closest_points(stencil, x);
  const auto first_count = static_cast<std::size_t>(stencil.first_count);
  clean({closest.weights.data(), first_count});
  clean({closest.weights.data() + first_count, count - first_count});
  Vector3 separation = Vector3::Zero();
  for (std::size_t k = 0; k < count; ++k) separation += closest.weights[k] * x[k];

  Contact contact;
  contact.distance = separation.norm();
  if (!(contact.distance > 0.0)) return std::nullopt;
  contact.normal = separation / contact.distance;
  ContactStencil along_line = stencil;
  along_line.normal = contact.normal;
  if (!(heights_at(along_line, positions).gap() > kMinGapOfDistance * contact.distance)) return std::nullopt;
  contact.most_gap = contact.distance;
  for (std::size_t k = 0; k < count; ++k) {
    if (closest.weights[k] == 0.0) continue;
    if (contact.count == Contact::kMostParticles) return std::nullopt;
    const auto slot = static_cast<std::size_t>(contact.count++);
    contact.particles[slot] = stencil.particles[k];
    contact.weights[slot] = closest.weights[k];
  }
  return contact;
}

}  // namespace sprung
