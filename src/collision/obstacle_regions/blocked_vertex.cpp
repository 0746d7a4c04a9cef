#include "collision/obstacle_regions/blocked_vertex.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

namespace sprung {

namespace {

// An affine map with a strain of 1 or more may turn its group inside out. A fit with more strain than this is rejected.
constexpr double kMaxStrain = 0.5;

// Triangles in one plane do not determine the map across the plane. A direction counts as across if the corners' spread along it is
// less than this fraction of the largest spread.
constexpr double kMinSpread = 0x1p-10;

/// The pseudo-inverse of a symmetric matrix: directions of small eigenvalues stay zero.
Matrix3 pseudo_inverse(const Matrix3& squares) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(squares);
  const double threshold = kMinSpread * kMinSpread * solver.eigenvalues()[2];
  Matrix3 inverse = Matrix3::Zero();
  for (int k = 0; k < 3; ++k) {
    const double square = solver.eigenvalues()[k];
    if (!(square > threshold)) continue;
    const Vector3 axis = solver.eigenvectors().col(k);
    inverse += axis * axis.transpose() / square;
  }
  return inverse;
}

/// The least-squares affine map of the triangles' corners that corrects the rigid motion.
AffineTransform fit(const RigidTransform& rigid, const std::vector<MovedTriangle>& triangles) {
  const double weight = 1.0 / static_cast<double>(3 * triangles.size());
  Vector3 center_before = Vector3::Zero();
  Vector3 center_after = Vector3::Zero();
  for (const MovedTriangle& triangle : triangles) {
    for (const Vector3& corner : triangle.before) center_before += weight * corner;
    for (const Vector3& corner : triangle.after) center_after += weight * corner;
  }
  AffineTransform map(rigid);
  Matrix3 squares = Matrix3::Zero();
  Matrix3 residual = Matrix3::Zero();
  for (const MovedTriangle& triangle : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 offset = triangle.before[k] - center_before;
      squares += offset * offset.transpose();
      residual += (triangle.after[k] - center_after - map.linear() * offset) * offset.transpose();
    }
  }
  const Matrix3 strain = residual * pseudo_inverse(squares);
  if (strain.norm() < kMaxStrain) map.linear() += strain;
  map.translation() = center_after - map.linear() * center_before;
  return map;
}

}  // namespace

AffineTransform common_motion(std::span<const BlockedVertex> blocked) {
  const auto moving = std::find_if(blocked.begin(), blocked.end(), [](const BlockedVertex& vertex) { return vertex.moves(); });
  const BlockedVertex& first = moving == blocked.end() ? blocked.front() : *moving;
  std::vector<MovedTriangle> triangles;
  for (const BlockedVertex& vertex : blocked) {
    if (vertex.surface && vertex.obstacle == first.obstacle) triangles.push_back(*vertex.surface);
  }
  return triangles.empty() ? AffineTransform(first.motion) : fit(first.motion, triangles);
}

}  // namespace sprung
