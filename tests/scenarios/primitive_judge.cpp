#include "scenarios/primitive_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace sprung::testing {
namespace {

ConvexMeasure measure(const SphereGeometry& sphere, const Vector3& p) { return {p.norm() - sphere.radius, p.normalized()}; }

ConvexMeasure measure(const BoxGeometry& box, const Vector3& p) {
  int axis = 0;
  const double value = (p.cwiseAbs() - 0.5 * box.size).maxCoeff(&axis);
  return {value, std::copysign(1.0, p[axis]) * Vector3::Unit(axis)};
}

ConvexMeasure measure(const CapsuleGeometry& capsule, const Vector3& p) {
  const double along = std::clamp(p.y(), -0.5 * capsule.length, 0.5 * capsule.length);
  const Vector3 from_axis = p - Vector3(0.0, along, 0.0);
  return {from_axis.norm() - capsule.radius, from_axis.normalized()};
}

ConvexMeasure measure(const CylinderGeometry& cylinder, const Vector3& p) {
  const Vector3 from_axis(p.x(), 0.0, p.z());
  const ConvexMeasure side = {from_axis.norm() - cylinder.radius, from_axis.normalized()};
  const ConvexMeasure end = {std::abs(p.y()) - 0.5 * cylinder.height, std::copysign(1.0, p.y()) * Vector3::UnitY()};
  return side.value > end.value ? side : end;
}

ConvexMeasure measure(const ConeGeometry& cone, const Vector3& p) {
  const double slope = cone.radius / cone.height;
  const Vector3 from_axis(p.x(), 0.0, p.z());
  const double length = std::hypot(1.0, slope);
  const ConvexMeasure side = {(from_axis.norm() - slope * (0.5 * cone.height - p.y())) / length,
                              (from_axis.normalized() + slope * Vector3::UnitY()) / length};
  const ConvexMeasure base = {-0.5 * cone.height - p.y(), -Vector3::UnitY()};
  return side.value > base.value ? side : base;
}

ConvexMeasure measure(const EllipsoidGeometry& ellipsoid, const Vector3& p) {
  const Vector3 scaled = p.cwiseQuotient(ellipsoid.radii);
  const double least_radius = ellipsoid.radii.minCoeff();
  return {least_radius * (scaled.norm() - 1.0), least_radius * scaled.normalized().cwiseQuotient(ellipsoid.radii)};
}

ConvexMeasure measure(const HalfSpaceGeometry& half_space, const Vector3& p) {
  return {half_space.normal.dot(p) - half_space.offset, half_space.normal};
}

ConvexMeasure measure(const MeshGeometry& /*mesh*/, const Vector3& /*p*/) { throw std::invalid_argument("a mesh is no primitive"); }
ConvexMeasure measure(const SequenceGeometry& /*sequence*/, const Vector3& /*p*/) {
  throw std::invalid_argument("a mesh is no primitive");
}

// The least value on [0, 1], by golden-section search: each round keeps 0.618 of the interval, and 64 rounds keep 4e-14. The search
// ends early once the function is certainly positive on the remaining interval, where its slope is at most `most_slope`.
double least(const std::function<double(double)>& convex, double most_slope) {
  constexpr double kFraction = std::numbers::phi - 1.0;
  double low = 0.0;
  double high = 1.0;
  double left = high - kFraction;
  double right = low + kFraction;
  double at_left = convex(left);
  double at_right = convex(right);
  double best = std::min({convex(low), convex(high), at_left, at_right});
  for (int round = 0; round < 64 && best > 0.0 && best <= most_slope * (high - low); ++round) {
    if (at_left <= at_right) {
      high = std::exchange(right, left);
      left = high - kFraction * (high - low);
      at_right = std::exchange(at_left, convex(left));
      best = std::min(best, at_left);
    } else {
      low = std::exchange(left, right);
      right = low + kFraction * (high - low);
      at_left = std::exchange(at_right, convex(right));
      best = std::min(best, at_right);
    }
  }
  return best;
}

class PrimitiveJudge final : public ObstacleJudge {
 public:
  explicit PrimitiveJudge(const ObstacleGeometry& geometry) : geometry_(geometry) {}

  [[nodiscard]] Index count_inside(const Points& positions) const override {
    Index count = 0;
    for (const auto& position : positions.colwise()) count += distance(position) <= 0.0 ? 1 : 0;
    return count;
  }

  [[nodiscard]] Index count_crossings(const std::vector<JudgedElement>& elements, const Points& positions) const override {
    Index count = 0;
    for (const JudgedElement& element : elements) count += reaches_inside(element, positions) ? 1 : 0;
    return count;
  }

  [[nodiscard]] double distance(const Vector3& point) const override { return convex_measure(geometry_, point).value; }

 private:
  [[nodiscard]] bool reaches_inside(const JudgedElement& element, const Points& positions) const;

  ObstacleGeometry geometry_;
};

// Whether a tangent plane of the convex function proves that it is positive on all of the element.
bool is_outside_for_certain(const ObstacleGeometry& geometry, const std::array<Vector3, 3>& corners, const Vector3& at) {
  const ConvexMeasure tangent = convex_measure(geometry, at);
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Vector3& corner) { return tangent.value + tangent.slope.dot(corner - at) > 0.0; });
}

bool PrimitiveJudge::reaches_inside(const JudgedElement& element, const Points& positions) const {
  const Vector3 a = positions.col(element.particles[0]);
  const Vector3 b = positions.col(element.particles[1]);
  const Vector3 c = positions.col(element.particles[element.corners == 3 ? 2 : 1]);
  if (std::min({distance(a), distance(b), distance(c)}) <= 0.0) return true;
  const std::array<Vector3, 3> corners = {a, b, c};
  for (const Vector3& at : {Vector3((a + b + c) / 3.0), a, b, c}) {
    if (is_outside_for_certain(geometry_, corners, at)) return false;
  }
  constexpr double kAnySlope = std::numeric_limits<double>::infinity();
  const auto least_towards_c = [&](double s) {
    return least([&](double t) { return distance(a + s * (b - a) + t * (1.0 - s) * (c - a)); }, kAnySlope);
  };
  return least(least_towards_c, (b - a).norm() + (c - a).norm()) <= 0.0;
}

}  // namespace

ConvexMeasure convex_measure(const ObstacleGeometry& geometry, const Vector3& p) {
  return std::visit([&](const auto& primitive) { return measure(primitive, p); }, geometry);
}

std::unique_ptr<const ObstacleJudge> judge_of_primitive(const ObstacleGeometry& geometry) {
  return std::make_unique<PrimitiveJudge>(geometry);
}

}  // namespace sprung::testing
