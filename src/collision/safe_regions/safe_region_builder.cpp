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

ZoneBuilder::ZoneBuilder(const ElementCorners& element, const ZoneRequest& request, Zone& zone)
    : element_(element), request_(request), zone_(zone), element_box_(box_around(element, 0.0)) {
  if (element.count == 3) element_face_ = (element.x[1] - element.x[0]).cross(element.x[2] - element.x[0]);
  zone_ = Zone{};
  zone_.box = asked_box(element, request);
}

void ZoneBuilder::look_at(Index triangle, const TriangleCorners& corners, const PairPlace& last) {
  if (zone_.triangle != kNone && !may_be_nearer(corners)) return;
  const ClosestPair pair = closest_pair(element_, corners, kPairSlack, request_.exact, last);
  const double distance = std::sqrt(pair.squared_distance);
  if (!(distance < zone_.distance)) return;
  zone_.distance = distance;
  zone_.point = pair.on_triangle;
  zone_.normal = distance > 0.0 ? Vector3((pair.on_simplex - pair.on_triangle) / distance) : Vector3::Zero();
  zone_.weights = pair.weights;
  zone_.triangle = triangle;
  zone_.place = pair.place;
  nearest_lowest_ = lowest(zone_.normal);
}

// The planes of the two faces tell many apart that the pair so far does not.
bool ZoneBuilder::may_be_nearer(const TriangleCorners& corners) const {
  if (highest_along(zone_.normal, corners) <= nearest_limit()) return false;
  const Vector3 face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (element_.count == 3 && is_beyond(face, corners[0], element_.x)) return false;
  return element_.count < 3 || !is_beyond(element_face_, element_.x[0], corners);
}

/// Whether all points are on one side of a plane, at the nearest distance or farther.
bool ZoneBuilder::is_beyond(const Vector3& normal, const Vector3& origin, const std::array<Vector3, 3>& points) const {
  const double first = normal.dot(points[0] - origin);
  const double second = normal.dot(points[1] - origin);
  const double third = normal.dot(points[2] - origin);
  const double height = std::max(std::min({first, second, third}), -std::max({first, second, third}));
  return height > 0.0 && height * height >= zone_.distance * zone_.distance * normal.squaredNorm();
}

void ZoneBuilder::meet(const TriangleCorners& corners) {
  if (ruled_out(corners)) return;
  if (zone_.plane_count == Zone::kMostPlanes && shrink_past(corners)) return;
  separate(corners);
}

bool ZoneBuilder::ruled_out(const TriangleCorners& corners) const {
  const Vector3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  if ((low.array() > zone_.box.max().array()).any() || (high.array() < zone_.box.min().array()).any()) return true;
  for (int k = 0; k < zone_.plane_count; ++k) {
    if (highest_along(normal(k), corners) <= limit(k)) return true;
  }
  return false;
}

bool ZoneBuilder::shrink_past(const TriangleCorners& corners) {
  const Vector3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  int axis = 0;
  int axis_below = 0;
  const double above = (low - element_box_.max()).maxCoeff(&axis);
  const double below = (element_box_.min() - high).maxCoeff(&axis_below);
  if (std::max(above, below) < kSmallestReach * request_.reach) return false;
  if (above >= below) {
    zone_.box.max()[axis] = element_box_.max()[axis] + (1.0 - kBoxMargin) * above;
  } else {
    zone_.box.min()[axis_below] = element_box_.min()[axis_below] - (1.0 - kBoxMargin) * below;
  }
  return true;
}

void ZoneBuilder::separate(const TriangleCorners& corners) {
  if (separate_by_face(corners)) return;
  const ClosestPair pair = closest_pair(element_, corners, kPairSlack);
  const TriangleSeparation found = separation(element_, corners, pair, kPairSlack);
  if (is_touching(found.gap, request_)) {
    keep_still(corners, std::sqrt(pair.squared_distance));
  } else {
    keep_above(corners, found);
  }
}

// The triangle's own plane is as good as any where it tells them apart by hardly less than the nearest triangle is away.
bool ZoneBuilder::separate_by_face(const TriangleCorners& corners) {
  const Vector3 face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = face.norm();
  if (!(length > 0.0)) return false;
  for (const double side : {1.0 / length, -1.0 / length}) {
    const Vector3 normal = side * face;
    const double gap = lowest(normal) - highest_along(normal, corners);
    if (!(gap >= kGoodPart * zone_.distance) || is_touching(gap, request_)) continue;
    keep_above(corners, {normal, gap});
    return true;
  }
  return false;
}

void ZoneBuilder::keep_above(const TriangleCorners& corners, const TriangleSeparation& found) {
  const auto& [normal, gap] = found;
  const double highest = highest_along(normal, corners);
  if (zone_.plane_count == Zone::kMostPlanes) {
    zone_.free_radius = std::min(zone_.free_radius, kFreePart * gap);
    return;
  }
  const double height = stand_off(gap, request_);
  const auto plane = static_cast<std::size_t>(zone_.plane_count++);
  zone_.planes[plane] = {normal, highest + height};
  limits_[plane] = highest + kBelowPlane * height;
}

// Rounding may leave no plane between what still does not cross: corners that move less than the distance cannot change that.
void ZoneBuilder::keep_still(const TriangleCorners& corners, double distance) {
  if (sprung::meets(element_, corners)) {
    zone_.broken = true;
  } else {
    zone_.free_radius = std::min(zone_.free_radius, kStillPart * distance);
  }
}

bool ZoneBuilder::grow_clear() {
  if (zone_.triangle != kNone) return false;
  const Vector3 side = Vector3::Constant((1.0 - kBoxMargin) / std::sqrt(3.0) * clear_);
  const Box3 box(element_box_.min() - side, element_box_.max() + side);
  if (!box.contains(zone_.box)) return false;
  zone_.box = box;
  return true;
}

void ZoneBuilder::finish() {
  if (zone_.broken) {
    zone_.plane_count = 0;
    zone_.clear = 0.0;
    return;
  }
  zone_.clear = std::min((1.0 - kPairSlack) * zone_.distance, clear_);
}

double ZoneBuilder::lowest(const Vector3& normal) const { return lowest_along(normal, element_); }

}  // namespace sprung
