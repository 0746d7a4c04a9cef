#include "collision/element_pair.h"

#include "geometry/closest_pair.h"

namespace sprung {
namespace {

// The plane across the points that are found separates by all but this part of the distance at least.
constexpr double kSlack = 0.01;

}  // namespace

Vector3 direction_between(const ElementPair& pair, const Points& positions) {
  std::array<Vector3, 6> x;
  for (int k = 0; k < pair.count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    x[at] = positions.col(pair.particles[at]);
  }
  Vector3 between;
  if (pair.second_count == 3) {
    const auto first = static_cast<std::size_t>(pair.first_count);
    const ClosestPair closest =
        closest_pair({.x = {x[0], x[1], x[2]}, .count = pair.first_count}, {x[first], x[first + 1], x[first + 2]}, kSlack);
    between = closest.on_simplex - closest.on_triangle;
  } else {
    const SegmentPair closest = closest_points_of_segments(x[0], x[1], x[2], x[3]);
    between = x[0] + closest.s * (x[1] - x[0]) - (x[2] + closest.t * (x[3] - x[2]));
  }
  const double distance = between.norm();
  return distance > 0.0 ? Vector3(between / distance) : Vector3::Zero();
}

}  // namespace sprung
