#include "collision/obstacle_regions/closest_point_tracker.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// An element that slides farther than this fraction of the gap may be closest to another triangle.
constexpr double kWholeSurface = 1.0;

// A contact plane is reused until the element has moved by this fraction of the gap. With an older plane the element would slide
// straight on over a curved surface, and press into it or leave it.
constexpr double kSameTriangle = 0.02;

// On a round surface the new closest point is nearer than the old one by the square of that motion. The leap keeps a rope that
// rests under load vibrating, so that it creeps: with 0.02 by 25 mm/s on a drum, with this by 0.01 mm/s.
constexpr double kSameTriangleOfRound = 0.0001;

}  // namespace

ClosestPointTracker::Search ClosestPointTracker::next_search(Index element, const ElementCorners& corners, const Vector3& drift,
                                                             double gap, bool is_round) {
  Record& record = records_[static_cast<std::size_t>(element)];
  double moved = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(corners.count); ++k) {
    moved = std::max(moved, (corners.x[k] + drift - record.corners[k]).squaredNorm());
  }
  moved = std::sqrt(moved);
  if (!(moved > (is_round ? kSameTriangleOfRound : kSameTriangle) * gap)) return Search::none;
  const bool same_triangle = record.travelled + moved <= kWholeSurface * gap;
  record.travelled = same_triangle ? record.travelled + moved : 0.0;
  return same_triangle ? Search::same_triangle : Search::whole_surface;
}

void ClosestPointTracker::shift(Index element, const Vector3& drift) {
  for (Vector3& corner : records_[static_cast<std::size_t>(element)].corners) corner += drift;
}

}  // namespace sprung
