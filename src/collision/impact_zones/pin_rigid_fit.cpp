#include "collision/impact_zones/pin_rigid_fit.h"

#include "collision/impact_zones/kabsch.h"

namespace sprung {

namespace {

// A rotation counts only if it leaves less than this fraction of the error of a translation: pins that move independently have
// none.
constexpr double kMaxError = 0.5;

// Trace of a rotation by a right angle. In a larger rotation, linear trajectories come too close to each other.
constexpr double kMinTrace = 1.0;

using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

}  // namespace

std::optional<RigidTransform> rigid_motion_of(std::span<const PinDisplacement> pins) {
  const auto count = static_cast<Eigen::Index>(pins.size());
  Columns before(3, count);
  Columns after(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    before.col(k) = pins[static_cast<std::size_t>(k)].from;
    after.col(k) = pins[static_cast<std::size_t>(k)].to;
  }
  const Vector3 center_before = before.rowwise().mean();
  const Vector3 center_after = after.rowwise().mean();
  before.colwise() -= center_before;
  after.colwise() -= center_after;
  const Matrix3 rotation = kabsch_rotation(after * before.transpose());
  const double error = (rotation * before - after).norm();
  if (rotation.trace() < kMinTrace || !(error < kMaxError * (before - after).norm())) return std::nullopt;
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = rotation;
  motion.translation() = center_after - rotation * center_before;
  return motion;
}

}  // namespace sprung
