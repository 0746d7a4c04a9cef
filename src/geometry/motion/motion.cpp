#include "geometry/motion/motion.h"

#include "geometry/motion/keyframe_span.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sprung {
namespace {

struct SineCosine {
  double sine;
  double cosine;
};

// Reduces to a quadrant first, so that quarter turns are exact and whole turns return the same bits.
SineCosine sine_cosine(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  const double quarters = std::nearbyint(turn / 90.0);
  const double radians = (turn - 90.0 * quarters) * std::numbers::pi / 180.0;
  const double s = std::sin(radians);
  const double c = std::cos(radians);
  switch (static_cast<int>(quarters)) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case -1:
      return {-c, s};
    default:
      return {-s, -c};
  }
}

// Rodrigues' formula.
Matrix3 rotation_about(const Vector3& axis, double degrees) {
  const auto [s, c] = sine_cosine(degrees);
  Matrix3 cross;
  cross << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return c * Matrix3::Identity() + s * cross + (1.0 - c) * axis * axis.transpose();
}

auto next_after(const std::vector<Keyframe>& keys, double time) {
  return std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Keyframe& key) { return t < key.time; });
}

Keyframe keyframe_at(const Motion& motion, double time) {
  const std::vector<Keyframe>& keys = motion.keyframes;
  if (keys.empty()) return {};
  const auto [before, after, s] = span_at(keys, time);
  const Keyframe& a = keys[before];
  const Keyframe& b = keys[after];
  if (before == after) return a;
  const double w = motion.interpolation == Interpolation::smooth ? s * s * (3.0 - 2.0 * s) : s;
  return {time, (1.0 - w) * a.position + w * b.position, (1.0 - w) * a.rotation + w * b.rotation};
}

/// The angle of a rotation [degrees].
double angle_between(const RigidTransform& a, const RigidTransform& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear())) * 180.0 / std::numbers::pi;
}

RigidTransform pose_at(const std::vector<TimedPose>& poses, double time) {
  const auto [before, after, fraction] = span_at(poses, time);
  const RigidTransform& a = poses[before].pose;
  const RigidTransform& b = poses[after].pose;
  if (fraction == 0.0) return a;
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = Eigen::Quaterniond(a.linear()).slerp(fraction, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  pose.translation() = (1.0 - fraction) * a.translation() + fraction * b.translation();
  return pose;
}

}  // namespace

Matrix3 rotation_from_degrees(const Vector3& degrees) {
  return rotation_about(Vector3::UnitZ(), degrees.z()) * rotation_about(Vector3::UnitY(), degrees.y()) *
         rotation_about(Vector3::UnitX(), degrees.x());
}

bool Motion::moves() const {
  const auto moved = [](const TimedPose& a, const TimedPose& b) { return a.pose.matrix() != b.pose.matrix(); };
  if (!poses.empty()) return std::adjacent_find(poses.begin(), poses.end(), moved) != poses.end();
  const auto differs = [](const Keyframe& a, const Keyframe& b) { return a.position != b.position || a.rotation != b.rotation; };
  return spin != Vector3::Zero() || std::adjacent_find(keyframes.begin(), keyframes.end(), differs) != keyframes.end();
}

double Motion::end() const {
  if (!poses.empty()) return moves() ? poses.back().time : 0.0;
  if (spin != Vector3::Zero()) return std::numeric_limits<double>::infinity();
  return moves() ? keyframes.back().time : 0.0;
}

double Motion::rotation(double begin, double end) const {
  if (!poses.empty()) {
    double angles = 0.0;
    for (std::size_t k = 1; k < poses.size(); ++k) {
      if (poses[k - 1].time < end && poses[k].time > begin) angles += angle_between(poses[k - 1].pose, poses[k].pose);
    }
    return angles;
  }
  double angles = spin.norm() * (end - begin);
  Keyframe last = keyframe_at(*this, begin);
  const auto turn_to = [&](const Keyframe& next) {
    angles += (next.rotation - last.rotation).lpNorm<1>();
    last = next;
  };
  for (auto key = next_after(keyframes, begin); key != keyframes.end() && key->time < end; ++key) turn_to(*key);
  turn_to(keyframe_at(*this, end));
  return angles;
}

RigidTransform Motion::pose(const RigidTransform& placed, double time) const {
  if (!poses.empty()) return pose_at(poses, time);
  const Keyframe key = keyframe_at(*this, time);
  Matrix3 turn = rotation_from_degrees(key.rotation);
  const double rate = spin.norm();
  if (rate > 0.0) turn = rotation_about(spin / rate, rate * time) * turn;
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = turn * placed.linear();
  pose.translation() = placed.translation() + key.position;
  return pose;
}

}  // namespace sprung
