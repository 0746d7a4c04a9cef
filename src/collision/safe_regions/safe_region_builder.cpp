#include "collision/safe_regions/safe_region_builder.h"

#include "geometry/queries/simplex_crossing.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// Edges are not looked at when corners and faces give a plane that separates by all but this part of the distance.
constexpr double kPairSlack = 0.005;

// A plane that separates by this part of the nearest triangle's distance is not improved.
constexpr double kGoodPart = 0.9;

// A triangle that rises no higher than this part of the way from another one to its plane needs none of its own: in a valley of
// small triangles there would be no end of them.
constexpr double kBelowPlane = 0.5;

// The box ends this far before a triangle, as a part of what lies between, so that rounding does not bring them together.
constexpr double kBoxMargin = 0.02;

// Boxes are cut down to this part of the reach; what is nearer than that needs a plane.
constexpr double kSmallestReach = 0.25;

// Corners that move less than this part of the distance cannot bring the element to the triangle.
constexpr double kFreePart = 0.9;

// And less than this part where the distance itself is hardly more than rounding.
constexpr double kStillPart = 0.5;

}  // namespace

SafeRegionBuilder::SafeRegionBuilder(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region)
    : element_(element), request_(request), region_(region), element_box_(box_around(element, 0.0)) {
  if (element.count == 3) element_face_ = (element.x[1] - element.x[0]).cross(element.x[2] - element.x[0]);
  region_ = SafeRegion{};
  region_.box = requested_box(element, request);
}

void SafeRegionBuilder::look_at(Index triangle, const TriangleCorners& corners, const PairPlace& last) {
  if (region_.triangle != kNone && !may_be_nearer(corners)) return;
  const ClosestPair pair = closest_pair(element_, corners, kPairSlack, request_.exact, last);
  const double distance = std::sqrt(pair.squared_distance);
  if (!(distance < region_.distance)) return;
  region_.distance = distance;
  region_.point = pair.on_triangle;
  region_.normal = distance > 0.0 ? Vector3((pair.on_simplex - pair.on_triangle) / distance) : Vector3::Zero();
  region_.weights = pair.weights;
  region_.triangle = triangle;
  region_.place = pair.place;
  nearest_lowest_ = lowest(region_.normal);
}

// The planes of the two faces tell many apart that the pair so far does not.
bool SafeRegionBuilder::may_be_nearer(const TriangleCorners& corners) const {
  if (highest_along(region_.normal, corners) <= nearest_limit()) return false;
  const Vector3 face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (element_.count == 3 && is_beyond(face, corners[0], element_.x)) return false;
  return element_.count < 3 || !is_beyond(element_face_, element_.x[0], corners);
}

/// Whether all points are on one side of a plane, at the nearest distance or farther.
bool SafeRegionBuilder::is_beyond(const Vector3& normal, const Vector3& origin, const std::array<Vector3, 3>& points) const {
  const double first = normal.dot(points[0] - origin);
  const double second = normal.dot(points[1] - origin);
  const double third = normal.dot(points[2] - origin);
  const double height = std::max(std::min({first, second, third}), -std::max({first, second, third}));
  return height > 0.0 && height * height >= region_.distance * region_.distance * normal.squaredNorm();
}

void SafeRegionBuilder::meet(const TriangleCorners& corners) {
  if (ruled_out(corners)) return;
  if (region_.plane_count == SafeRegion::kMostPlanes && shrink_past(corners)) return;
  separate(corners);
}

bool SafeRegionBuilder::ruled_out(const TriangleCorners& corners) const {
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
    keep_still(corners, std::sqrt(pair.squared_distance));
  } else {
    keep_above(corners, found);
  }
}

// The triangle's own plane is as good as any where it tells them apart by hardly less than the nearest triangle is away.
bool SafeRegionBuilder::separate_by_face(const TriangleCorners& corners) {
  const Vector3 face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = face.norm();
  if (!(length > 0.0)) return false;
  for (const double side : {1.0 / length, -1.0 / length}) {
    const Vector3 normal = side * face;
    const double gap = lowest(normal) - highest_along(normal, corners);
    if (!(gap >= kGoodPart * region_.distance) || is_touching(gap, request_)) continue;
    keep_above(corners, {normal, gap});
    return true;
  }
  return false;
}

void SafeRegionBuilder::keep_above(const TriangleCorners& corners, const TriangleSeparatingPlane& found) {
  const auto& [normal, gap] = found;
  const double highest = highest_along(normal, corners);
  if (region_.plane_count == SafeRegion::kMostPlanes) {
    region_.free_radius = std::min(region_.free_radius, kFreePart * gap);
    return;
  }
  const double height = stand_off(gap, request_);
  const auto plane = static_cast<std::size_t>(region_.plane_count++);
  region_.planes[plane] = {normal, highest + height};
  limits_[plane] = highest + kBelowPlane * height;
}

// Rounding may leave no plane between what still does not cross: corners that move less than the distance cannot change that.
void SafeRegionBuilder::keep_still(const TriangleCorners& corners, double distance) {
  if (sprung::meets(element_, corners)) {
    region_.broken = true;
  } else {
    region_.free_radius = std::min(region_.free_radius, kStillPart * distance);
  }
}

bool SafeRegionBuilder::grow_clear() {
  if (region_.triangle != kNone) return false;
  const Vector3 side = Vector3::Constant((1.0 - kBoxMargin) / std::sqrt(3.0) * clear_);
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
  region_.clear = std::min((1.0 - kPairSlack) * region_.distance, clear_);
}

double SafeRegionBuilder::lowest(const Vector3& normal) const { return lowest_along(normal, element_); }

}  // namespace sprung
