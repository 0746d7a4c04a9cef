#include "collision/impact_zones/pin_rigid_fit.h"

#include "collision/impact_zones/kabsch.h"

namespace sprung {

namespace {

// Pins that go ways of their own are not turned by those: a turn leaves at most this part of what translation alone misses.
constexpr double kWorthwhile = 0.5;

// Of a turn by a right angle: straight ways of what turns by more come too near each other.
constexpr double kLeastTrace = 1.0;

using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

}  // namespace

std::optional<RigidTransform> common_turn(std::span<const PinDisplacement> pins) {
  const auto count = static_cast<Eigen::Index>(pins.size());
  Columns before(3, count);
  Columns after(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    before.col(k) = pins[static_cast<std::size_t>(k)].from;
    after.col(k) = pins[static_cast<std::size_t>(k)].to;
  }
  const Vector3 middle_before = before.rowwise().mean();
  const Vector3 middle_after = after.rowwise().mean();
  before.colwise() -= middle_before;
  after.colwise() -= middle_after;
  const Matrix3 turn = kabsch_rotation(after * before.transpose());
  const double missed = (turn * before - after).norm();
  if (turn.trace() < kLeastTrace || !(missed < kWorthwhile * (before - after).norm())) return std::nullopt;
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = turn;
  motion.translation() = middle_after - turn * middle_before;
  return motion;
}

}  // namespace sprung
