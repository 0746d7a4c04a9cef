#include "collision/pin_motion.h"

#include <Eigen/SVD>

namespace sprung {

namespace {

// Pins whose spread across a line has a square of less than this part of that along it say nothing of turns about the line.
constexpr double kLeastSquare = 0x1p-20;

// As a part of the largest coordinate, ways that differ by no more are the same.
constexpr double kRounding = 0x1p-50;

using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

Matrix3 common_turn(const Columns& before, const Columns& after) {
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

RigidTransform common_motion(std::span<const PinWay> pins) {
  const auto count = static_cast<Eigen::Index>(pins.size());
  Columns before(3, count);
  Columns after(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    before.col(k) = pins[static_cast<std::size_t>(k)].from;
    after.col(k) = pins[static_cast<std::size_t>(k)].to;
  }
  const Vector3 middle_before = before.rowwise().mean();
  const Vector3 middle_after = after.rowwise().mean();
  RigidTransform motion = RigidTransform::Identity();
  const Columns ways = after - before;
  const double apart = (ways.colwise() - ways.col(0)).cwiseAbs().maxCoeff();
  const bool turns = apart > kRounding * before.cwiseAbs().maxCoeff();
  if (turns) motion.linear() = common_turn(before.colwise() - middle_before, after.colwise() - middle_after);
  motion.translation() = middle_after - motion.linear() * middle_before;
  return motion;
}

}  // namespace sprung
