#include "collision/impact_zones/group_motion.h"

#include <Eigen/SVD>

namespace sprung {
namespace {

Matrix3 cofactors(const Matrix3& m) {
  Matrix3 result;
  result << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
  return result;
}

// Points count as collinear if the second singular value, a squared extent, is below this fraction of the first. Rounding would
// choose the rotation about their line otherwise.
constexpr double kCollinear = 0x1p-40;

// A rotation counts only if it leaves less than this fraction of the error of a translation: pins that move independently have
// none.
constexpr double kMaxError = 0.5;

// Trace of a rotation by a right angle. In a larger rotation, linear trajectories come too close to each other.
constexpr double kMinTrace = 1.0;

using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// The rotation R that minimises the sum of w |R a - b|^2 over points a and b, relative to their centroids, with weights w, where
/// `covariance` is the sum of w b a^T (Kabsch 1976). Collinear points do not determine the rotation about their line; R then does
/// not rotate about it.
Matrix3 kabsch_rotation(const Matrix3& covariance) {
  const Eigen::JacobiSVD<Matrix3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3& squares = svd.singularValues();
  if (!(squares[0] > 0.0)) return Matrix3::Identity();
  if (squares[1] <= kCollinear * squares[0]) {
    return Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0)).normalized().toRotationMatrix();
  }
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3(1.0, 1.0, handedness).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

MovedPlane moved_plane(const Vector3& normal, const Matrix3& linear) {
  const Matrix3 at_end = cofactors(linear);
  const Matrix3 midway = 0.5 * (cofactors(Matrix3::Identity() + linear) - Matrix3::Identity() - at_end);
  return {normal, midway * normal, at_end * normal};
}

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
