#include "collision/pairs/pair_contact.h"

#include "geometry/queries/closest_pair.h"

#include <cmath>
#include <span>

namespace sprung {
namespace {

// Corners that have less than this of their side's point are none of it but for rounding: but for sides that lie along each other,
// at most four have more, one and three or two and two.
constexpr double kNoWeight = 1.0e-9;

// Next to touching, the line between the nearest points is mostly rounding: one that separates the sides by less than this part of
// what it should says nothing.
constexpr double kSeparated = 0.5;

/// Weights of the second side's points are negative.
struct Sides {
  std::array<double, 6> weights{};
  Vector3 between = Vector3::Zero();  ///< from the second side's point to the first's [m]
};

/// Without corners that rounding alone gives a part, of all of the point again.
void clean(std::span<double> weights) {
  double sum = 0.0;
  for (double& weight : weights) {
    if (std::abs(weight) <= kNoWeight) weight = 0.0;
    sum += std::abs(weight);
  }
  for (double& weight : weights) weight /= sum;
}

/// From one of them, so that it does not matter how far from the origin they are.
std::array<Vector3, 6> corners(const ConvexPair& pair, const Points& positions) {
  std::array<Vector3, 6> x;
  const Vector3 origin = positions.col(pair.particles[0]);
  for (std::size_t k = 0; k < static_cast<std::size_t>(pair.count()); ++k) x[k] = positions.col(pair.particles[k]) - origin;
  return x;
}

Sides nearest_points(const ConvexPair& pair, const Points& positions) {
  const std::array<Vector3, 6> x = corners(pair, positions);
  const auto first_count = static_cast<std::size_t>(pair.first_count);
  Sides sides;
  if (pair.second_count == 2) {
    const SegmentPair nearest = closest_points_of_segments(x[0], x[1], x[2], x[3]);
    sides.weights = {1.0 - nearest.s, nearest.s, nearest.t - 1.0, -nearest.t};
  } else {
    const std::array<Vector3, 3> second{x[first_count], x[first_count + 1], x[first_count + 2]};
    const ClosestPair nearest = closest_pair({.x = {x[0], x[1], x[2]}, .count = pair.first_count}, second);
    const ClosestPoint on_second = closest_point_on_triangle(nearest.on_triangle, second[0], second[1], second[2]);
    const Vector3 weights = barycentric(on_second, second[0], second[1], second[2]);
    for (std::size_t k = 0; k < first_count; ++k) sides.weights[k] = nearest.weights[static_cast<Eigen::Index>(k)];
    for (std::size_t k = 0; k < 3; ++k) sides.weights[first_count + k] = -weights[static_cast<Eigen::Index>(k)];
  }
  clean({sides.weights.data(), first_count});
  clean({sides.weights.data() + first_count, static_cast<std::size_t>(pair.second_count)});
  for (std::size_t k = 0; k < static_cast<std::size_t>(pair.count()); ++k) sides.between += sides.weights[k] * x[k];
  return sides;
}

}  // namespace

std::optional<Contact> meeting_of(const ConvexPair& pair, const Points& positions) {
  const Sides sides = nearest_points(pair, positions);
  Contact contact;
  contact.distance = sides.between.norm();
  if (!(contact.distance > 0.0)) return std::nullopt;
  contact.normal = sides.between / contact.distance;
  ConvexPair along = pair;
  along.normal = contact.normal;
  if (!(heights_at(along, positions).gap() > kSeparated * contact.distance)) return std::nullopt;
  contact.most_gap = contact.distance;
  for (std::size_t k = 0; k < static_cast<std::size_t>(pair.count()); ++k) {
    if (sides.weights[k] == 0.0) continue;
    if (contact.count == Contact::kMostParticles) return std::nullopt;
    const auto slot = static_cast<std::size_t>(contact.count++);
    contact.particles[slot] = pair.particles[k];
    contact.weights[slot] = sides.weights[k];
  }
  return contact;
}

}  // namespace sprung
