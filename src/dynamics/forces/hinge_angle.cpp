#include "dynamics/forces/hinge_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sprung {

HingeAngle::HingeAngle(const Hinges& hinges, Index hinge, const Points& x) {
  for (std::size_t i = 0; i < 4; ++i) x_[i] = x.col(hinges.particles[hinge][i]);
  edge_ = x_[1] - x_[0];
  length_ = edge_.norm();
  left_ = triangle_of(edge_.cross(x_[2] - x_[0]), hinges.rest_area[hinge][0]);
  right_ = triangle_of((x_[3] - x_[0]).cross(edge_), hinges.rest_area[hinge][1]);
  has_angle_ = left_.per_area > 0.0 && right_.per_area > 0.0 && length_ > 0.0;
  angle_from_rest_ = has_angle_ ? angle_from(hinges.rest_angle[hinge]) : 0.0;
}

double HingeAngle::deviation() const { return angle_from_rest_ * left_.factor * right_.factor; }

double HingeAngle::angle_from(double rest_angle) const {
  const double sine = right_.normal.cross(left_.normal).dot(edge_) / length_;
  const double angle = std::atan2(sine, left_.normal.dot(right_.normal));
  return std::remainder(angle - rest_angle, 2.0 * std::numbers::pi);
}

HingeAngle::Triangle HingeAngle::triangle_of(const Vector3& doubled_area, double rest_area) {
  const double size = doubled_area.norm();
  if (!(size > 0.0)) return {.factor = 0.0};
  const double at_rest = 2.0 * rest_area;
  const double part = std::min(1.0, size / at_rest);
  Triangle triangle{.normal = doubled_area / size, .factor = part * part * (3.0 - 2.0 * part)};
  triangle.per_area = triangle.factor / size;
  triangle.slope = 6.0 * part * (1.0 - part) / at_rest;
  return triangle;
}

std::array<Vector3, 4> HingeAngle::gradient() const {
  const auto& [a, b, c, d] = x_;
  if (!has_angle_) return {Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  const Vector3 at_c = length_ * left_.per_area * right_.factor * left_.normal;
  const Vector3 at_d = length_ * right_.per_area * left_.factor * right_.normal;
  const double foot_c = (c - a).dot(edge_) / length_ / length_;
  const double foot_d = (d - a).dot(edge_) / length_ / length_;
  std::array<Vector3, 4> gradient{(foot_c - 1.0) * at_c + (foot_d - 1.0) * at_d, -foot_c * at_c - foot_d * at_d, at_c, at_d};
  if (left_.slope > 0.0) {
    const Vector3 normal = angle_from_rest_ * right_.factor * left_.slope * left_.normal;
    gradient[0] += normal.cross(c - b);
    gradient[1] += normal.cross(a - c);
    gradient[2] += normal.cross(edge_);
  }
  if (right_.slope > 0.0) {
    const Vector3 normal = angle_from_rest_ * left_.factor * right_.slope * right_.normal;
    gradient[0] += normal.cross(b - d);
    gradient[1] += normal.cross(d - a);
    gradient[3] += normal.cross(-edge_);
  }
  return gradient;
}

}  // namespace sprung
