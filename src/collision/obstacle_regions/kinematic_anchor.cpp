#include "collision/obstacle_regions/kinematic_anchor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

namespace sprung {

namespace {

// A map that deforms more than this is not the one that was looked for: it could turn what it maps inside out from 1 on.
constexpr double kMostStrain = 0.5;

// Triangles in one plane say nothing about the direction across it: that in which corners spread by less than this part of the
// widest.
constexpr double kLeastSpread = 0x1p-10;

/// The inverse in the directions in which a symmetric matrix is not next to nothing.
Matrix3 inverse_where_spread(const Matrix3& squares) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(squares);
  const double least = kLeastSpread * kLeastSpread * solver.eigenvalues()[2];
  Matrix3 inverse = Matrix3::Zero();
  for (int k = 0; k < 3; ++k) {
    const double square = solver.eigenvalues()[k];
    if (!(square > least)) continue;
    const Vector3 axis = solver.eigenvectors().col(k);
    inverse += axis * axis.transpose() / square;
  }
  return inverse;
}

AffineTransform fit(const RigidTransform& rigid, const std::vector<MovedTriangle>& triangles) {
  const double part = 1.0 / static_cast<double>(3 * triangles.size());
  Vector3 before = Vector3::Zero();
  Vector3 after = Vector3::Zero();
  for (const MovedTriangle& triangle : triangles) {
    for (const Vector3& corner : triangle.before) before += part * corner;
    for (const Vector3& corner : triangle.after) after += part * corner;
  }
  AffineTransform map(rigid);
  Matrix3 squares = Matrix3::Zero();
  Matrix3 missed = Matrix3::Zero();
  for (const MovedTriangle& triangle : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 beside = triangle.before[k] - before;
      squares += beside * beside.transpose();
      missed += (triangle.after[k] - after - map.linear() * beside) * beside.transpose();
    }
  }
  const Matrix3 strain = missed * inverse_where_spread(squares);
  if (strain.norm() < kMostStrain) map.linear() += strain;
  map.translation() = after - map.linear() * before;
  return map;
}

}  // namespace

AffineTransform common_motion(std::span<const KinematicAnchor> anchors) {
  const auto moving = std::find_if(anchors.begin(), anchors.end(), [](const KinematicAnchor& anchor) { return anchor.moves(); });
  const KinematicAnchor& first = moving == anchors.end() ? anchors.front() : *moving;
  std::vector<MovedTriangle> triangles;
  for (const KinematicAnchor& anchor : anchors) {
    if (anchor.surface && anchor.obstacle == first.obstacle) triangles.push_back(*anchor.surface);
  }
  return triangles.empty() ? AffineTransform(first.motion) : fit(first.motion, triangles);
}

}  // namespace sprung
