#include "collision/pair_meeting.h"

#include "geometry/closest_pair.h"

#include <cmath>

namespace sprung {
namespace {

// Corners that have less than this of their side's point are none of it but for rounding: at most four have more, one and three or
// two and two.
constexpr double kNoWeight = 1.0e-9;

// Next to touching, the line between the nearest points is mostly rounding: one that separates the sides by less than this part of
// what it should says nothing.
constexpr double kSeparated = 0.5;

/// Weights of the second side's points are negative.
struct Sides {
  std::array<double, 6> weights{};
  Vector3 between = Vector3::Zero();  ///< from the second side's point to the first's [m]
};

Sides nearest_points(const ElementPair& pair, const Points& positions) {
  const auto corner = [&](int k) { return Vector3(positions.col(pair.particles[static_cast<std::size_t>(k)])); };
  if (pair.second_count == 2) {
    const SegmentPair nearest = closest_points_of_segments(corner(0), corner(1), corner(2), corner(3));
    const Sides sides{.weights = {1.0 - nearest.s, nearest.s, nearest.t - 1.0, -nearest.t}};
    Vector3 between = Vector3::Zero();
    for (int k = 0; k < 4; ++k) between += sides.weights[static_cast<std::size_t>(k)] * corner(k);
    return {sides.weights, between};
  }
  Simplex first{.x = {}, .count = pair.first_count};
  for (int k = 0; k < pair.first_count; ++k) first.x[static_cast<std::size_t>(k)] = corner(k);
  const int begin = pair.first_count;
  const std::array<Vector3, 3> second{corner(begin), corner(begin + 1), corner(begin + 2)};
  const ClosestPair nearest = closest_pair(first, second);
  const ClosestPoint again = closest_point_on_triangle(nearest.on_simplex, second[0], second[1], second[2]);
  const Vector3 weights = barycentric(again, second[0], second[1], second[2]);
  Sides sides{.weights = {}, .between = nearest.on_simplex - again.point};
  for (int k = 0; k < pair.first_count; ++k) sides.weights[static_cast<std::size_t>(k)] = nearest.weights[k];
  for (int k = 0; k < 3; ++k) sides.weights[static_cast<std::size_t>(begin + k)] = -weights[k];
  return sides;
}

}  // namespace

std::optional<Contact> meeting_of(const ElementPair& pair, const Points& positions) {
  const Sides sides = nearest_points(pair, positions);
  Contact contact;
  contact.distance = sides.between.norm();
  if (!(contact.distance > 0.0)) return std::nullopt;
  contact.normal = sides.between / contact.distance;
  ElementPair along = pair;
  along.normal = contact.normal;
  if (!(heights_at(along, positions).gap() > kSeparated * contact.distance)) return std::nullopt;
  contact.most_gap = contact.distance;
  for (std::size_t k = 0; k < static_cast<std::size_t>(pair.count()) && contact.count < Contact::kMostParticles; ++k) {
    if (std::abs(sides.weights[k]) <= kNoWeight) continue;
    const auto slot = static_cast<std::size_t>(contact.count++);
    contact.particles[slot] = pair.particles[k];
    contact.weights[slot] = sides.weights[k];
  }
  return contact;
}

}  // namespace sprung
