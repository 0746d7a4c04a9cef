#include "collision/pin_motion.h"

#include <Eigen/SVD>

namespace sprung {

namespace {

// Of pins next to a line, whose second singular value, as that of a spread squared, is less than this part of the first, rounding
// would choose the turn about it.
constexpr double kLeastSquare = 0x1p-40;

// Pins that go ways of their own are not turned by those: a turn leaves at most this part of what translation alone misses.
constexpr double kWorthwhile = 0.5;

// Of a turn by a right angle: straight ways of what turns by more come too near each other.
constexpr double kLeastTrace = 1.0;

using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

Matrix3 best_turn(const Columns& before, const Columns& after) {
  const Eigen::JacobiSVD<Matrix3> svd(after * before.transpose(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3& squares = svd.singularValues();
  if (!(squares[0] > 0.0)) return Matrix3::Identity();
  if (squares[1] <= kLeastSquare * squares[0]) {
    return Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0)).normalized().toRotationMatrix();
  }
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3(1.0, 1.0, handedness).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

std::optional<RigidTransform> common_turn(std::span<const PinWay> pins) {
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
  const Matrix3 turn = best_turn(before, after);
  const double missed = (turn * before - after).norm();
  if (turn.trace() < kLeastTrace || !(missed < kWorthwhile * (before - after).norm())) return std::nullopt;
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = turn;
  motion.translation() = middle_after - turn * middle_before;
  return motion;
}

}  // namespace sprung
