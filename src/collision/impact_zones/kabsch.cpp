#include "collision/impact_zones/kabsch.h"

#include <Eigen/SVD>

namespace sprung {

namespace {

// Points count as collinear if the second singular value, a squared extent, is below this fraction of the first. Rounding would
// choose the rotation about their line otherwise.
constexpr double kCollinear = 0x1p-40;

}  // namespace

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

}  // namespace sprung
