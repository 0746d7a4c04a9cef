#include "collision/pairs/contact_candidate.h"

#include "geometry/queries/closest_pair.h"

namespace sprung {

ClosestFeatures closest_points(const ContactCandidate& candidate, const std::array<Vector3, 4>& x) {
  ClosestFeatures closest;
  if (candidate.edges) {
    const SegmentPair found = closest_points_of_segments(x[0], x[1], x[2], x[3]);
    closest.weights = {1.0 - found.s, found.s, found.t - 1.0, -found.t};
    closest.separation = x[0] + found.s * (x[1] - x[0]) - (x[2] + found.t * (x[3] - x[2]));
  } else {
    const ClosestPoint found = closest_point_on_triangle(x[0], x[1], x[2], x[3]);
    const Vector3 weights = barycentric(found, x[1], x[2], x[3]);
    closest.weights = {1.0, -weights[0], -weights[1], -weights[2]};
    closest.separation = x[0] - found.point;
  }
  return closest;
}

}  // namespace sprung
