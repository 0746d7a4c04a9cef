#include "collision/primitives/convex_line_search.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

/// If the closest point of the shape is the same along the edge, the distance is a hyperbola and this function is linear.
double steepness(double slope) { return slope / std::sqrt(std::max((1.0 - slope) * (1.0 + slope), 1e-30)); }

double zero_of_steepness(const EdgeSample& low, const EdgeSample& high) {
  const double falls = steepness(low.slope);
  return low.along + (high.along - low.along) * falls / (falls - steepness(high.slope));
}

}  // namespace

EdgeSample crossing_of_tangents(const EdgeSample& low, const EdgeSample& high) {
  const double width = high.along - low.along;
  const double ahead = (high.distance - low.distance - high.slope * width) / (low.slope - high.slope);
  return {low.along + ahead, low.distance + low.slope * ahead, 0.0};
}

double ConvexLineSearch::next() {
  const int rule = steps_++ % 3;
  const double width = high_.along - low_.along;
  const double at = rule == 1 ? crossing_of_tangents(low_, high_).along : zero_of_steepness(low_, high_);
  const bool slow = rule == 2 && width > 0.5 * width_;
  if (rule == 2) width_ = width;
  return slow || !contains(at) ? low_.along + 0.5 * width : at;
}

}  // namespace sprung
