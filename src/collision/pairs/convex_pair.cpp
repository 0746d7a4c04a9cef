#include "collision/pairs/convex_pair.h"

#include "collision/safe_regions/triangle_separating_plane.h"
#include "geometry/queries/closest_pair.h"

namespace sprung {
namespace {

// The plane across the points that are found separates by all but this part of the distance at least.
constexpr double kSlack = 0.01;

}  // namespace

Vector3 direction_between(const ConvexPair& pair, const Points& positions) {
  std::array<Vector3, 6> x;
  for (int k = 0; k < pair.count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    x[at] = positions.col(pair.particles[at]);
  }
  const auto first = static_cast<std::size_t>(pair.first_count);
  // An edge is a triangle of which two corners are one.
  const TriangleCorners second{x[first], x[first + 1], x[first + static_cast<std::size_t>(pair.second_count - 1)]};
  const Simplex sides{.x = {x[0], x[1], x[2]}, .count = pair.first_count};
  ClosestPair closest;
  if (pair.second_count == 3) {
    closest = closest_pair(sides, second, kSlack);
  } else {
    const SegmentPair of_edges = closest_points_of_segments(x[0], x[1], x[2], x[3]);
    closest.on_simplex = x[0] + of_edges.s * (x[1] - x[0]);
    closest.on_triangle = x[2] + of_edges.t * (x[3] - x[2]);
    closest.squared_distance = (closest.on_simplex - closest.on_triangle).squaredNorm();
  }
  return separation(sides, second, closest, kSlack).normal;
}

}  // namespace sprung
