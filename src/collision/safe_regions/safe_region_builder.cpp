#include "collision/safe_regions/safe_region_builder.h"

#include "geometry/queries/simplex_crossing.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// Edge pairs are skipped if a corner-face pair yields a plane that separates by all of the distance except this fraction.
constexpr double kPairSlack = 0.005;

// A plane that separates by this fraction of the nearest triangle's distance is good enough.
constexpr double kGoodFraction = 0.9;

// A triangle needs no plane of its own if it rises at most this fraction of the distance between another triangle and its plane.
// Without this rule a valley of small triangles would need any number of planes.
constexpr double kBelowPlane = 0.5;

// The box ends before a triangle by this fraction of the distance, which exceeds rounding.
constexpr double kBoxMargin = 0.02;

// The box is cut down to this fraction of the reach at most. Nearer triangles need a plane.
constexpr double kSmallestReach = 0.25;

// A triangle without a plane limits the displacement of the corners to this fraction of its distance.
constexpr double kFreeFraction = 0.9;

// The same fraction where the distance is within rounding of 0.
constexpr double kTouchingFreeFraction = 0.5;

}  // namespace

SafeRegionBuilder::SafeRegionBuilder(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region)
    : element_(element), request_(request), region_(region), element_box_(box_around(element, 0.0)) {
  if (element.count == 3) element_face_ = (element.x[1] - element.x[0]).cross(element.x[2] - element.x[0]);
  region_ = SafeRegion{};
  region_.box = requested_box(element, request);
}

void SafeRegionBuilder::consider(Index triangle, const TriangleCorners& corners, const FeaturePair& last) {
  if (region_.triangle != kNone && !may_be_nearer(corners)) return;
  const ClosestPair pair = closest_pair(element_, corners, kPairSlack, request_.exact, last);
  const double distance = std::sqrt(pair.squared_distance);
  if (!(distance < region_.distance)) return;
  region_.distance = distance;
  region_.point = pair.on_triangle;
  region_.normal = distance > 0.0 ? Vector3((pair.on_simplex - pair.on_triangle) / distance) : Vector3::Zero();
  region_.weights = pair.weights;
  region_.triangle = triangle;
  region_.features = pair.features;
  nearest_lowest_ = lowest(region_.normal);
}

// The planes of the two faces reject many triangles that the plane of the closest points does not.
bool SafeRegionBuilder::may_be_nearer(const TriangleCorners& corners) const {
  if (highest_along(region_.normal, corners) <= nearest_limit()) return false;
  const Vector3 face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (element_.count == 3 && is_beyond(face, corners[0], element_.x)) return false;
  return element_.count < 3 || !is_beyond(element_face_, element_.x[0], corners);
}

/// Whether all points are on one side of a plane, at least at the nearest distance.
bool SafeRegionBuilder::is_beyond(const Vector3& normal, const Vector3& origin, const std::array<Vector3, 3>& points) const {
  const double first = normal.dot(points[0] - origin);
  const double second = normal.dot(points[1] - origin);
  const double third = normal.dot(points[2] - origin);
  const double height = std::max(std::min({first, second, third}), -std::max({first, second, third}));
  return height > 0.0 && height * height >= region_.distance * region_.distance * normal.squaredNorm();
}

void SafeRegionBuilder::exclude(const TriangleCorners& corners) {
  if (is_excluded(corners)) return;
  if (region_.plane_count == SafeRegion::kMostPlanes && shrink_past(corners)) return;
  separate(corners);
}

bool SafeRegionBuilder::is_excluded(const TriangleCorners& corners) const {
  const Vector3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  if ((low.array() > region_.box.max().array()).any() || (high.array() < region_.box.min().array()).any()) return true;
  for (int k = 0; k < region_.plane_count; ++k) {
    if (highest_along(normal(k), corners) <= limit(k)) return true;
  }
  return false;
}

bool SafeRegionBuilder::shrink_past(const TriangleCorners& corners) {
  const Vector3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  int axis = 0;
  int axis_below = 0;
  const double above = (low - element_box_.max()).maxCoeff(&axis);
  const double below = (element_box_.min() - high).maxCoeff(&axis_below);
  if (std::max(above, below) < kSmallestReach * request_.reach) return false;
  if (above >= below) {
    region_.box.max()[axis] = element_box_.max()[axis] + (1.0 - kBoxMargin) * above;
  } else {
    region_.box.min()[axis_below] = element_box_.min()[axis_below] - (1.0 - kBoxMargin) * below;
  }
  return true;
}

void SafeRegionBuilder::separate(const TriangleCorners& corners) {
  if (separate_by_face(corners)) return;
  const ClosestPair pair = closest_pair(element_, corners, kPairSlack);
  const TriangleSeparatingPlane found = separation(element_, corners, pair, kPairSlack);
  if (is_touching(found.gap, request_)) {
    limit_motion(corners, std::sqrt(pair.squared_distance));
  } else {
    add_plane(corners, found);
  }
}

// The plane of the triangle itself is good enough if it separates by nearly the distance of the nearest triangle.
bool SafeRegionBuilder::separate_by_face(const TriangleCorners& corners) {
  const Vector3 face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = face.norm();
  if (!(length > 0.0)) return false;
  for (const double side : {1.0 / length, -1.0 / length}) {
    const Vector3 normal = side * face;
    const double gap = lowest(normal) - highest_along(normal, corners);
    if (!(gap >= kGoodFraction * region_.distance) || is_touching(gap, request_)) continue;
    add_plane(corners, {normal, gap});
    return true;
  }
  return false;
}

void SafeRegionBuilder::add_plane(const TriangleCorners& corners, const TriangleSeparatingPlane& found) {
  const auto& [normal, gap] = found;
  const double highest = highest_along(normal, corners);
  if (region_.plane_count == SafeRegion::kMostPlanes) {
    region_.free_radius = std::min(region_.free_radius, kFreeFraction * gap);
    return;
  }
  const double height = stand_off(gap, request_);
  const auto plane = static_cast<std::size_t>(region_.plane_count++);
  region_.planes[plane] = {normal, highest + height};
  limits_[plane] = highest + kBelowPlane * height;
}

// Because of rounding, no plane may separate two simplices that nearly touch. A small enough displacement still keeps them apart.
void SafeRegionBuilder::limit_motion(const TriangleCorners& corners, double distance) {
  if (sprung::intersects(element_, corners)) {
    region_.broken = true;
  } else {
    region_.free_radius = std::min(region_.free_radius, kTouchingFreeFraction * distance);
  }
}

bool SafeRegionBuilder::grow_to_clear_distance() {
  if (region_.triangle != kNone) return false;
  const Vector3 side = Vector3::Constant((1.0 - kBoxMargin) / std::sqrt(3.0) * clear_distance_);
  const Box3 box(element_box_.min() - side, element_box_.max() + side);
  if (!box.contains(region_.box)) return false;
  region_.box = box;
  return true;
}

void SafeRegionBuilder::finish() {
  if (region_.broken) {
    region_.plane_count = 0;
    region_.clear = 0.0;
    return;
  }
  region_.clear = std::min((1.0 - kPairSlack) * region_.distance, clear_distance_);
}

double SafeRegionBuilder::lowest(const Vector3& normal) const { return lowest_along(normal, element_); }

}  // namespace sprung
