#include "dynamics/integrators/implicit_friction.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <array>

namespace sprung {
namespace {

double smallest_eigenvalue(const Matrix3& stiffness) {
  return Eigen::SelfAdjointEigenSolver<Matrix3>(stiffness).eigenvalues().minCoeff();
}

// The stiffness resists: without a negative eigenvalue, but for rounding of its largest entry, |f| / |slip| = 1e3 * 1e-16. Three
// supports leave no direction to slip in: a slip is then rounding error of any direction.
TEST(ImplicitFriction, HasNoNegativeStiffness) {
  const Matrix3 one = Vector3::UnitY() * Vector3::UnitY().transpose();
  const Vector3 impulse(1.0, 2.0, 0.0);
  ImplicitFriction on_a_plane;
  on_a_plane.begin(one, Vector3(0.0, 1.0e-3, 0.0), Vector3(1.0e-3, 0.0, 0.0), impulse);
  EXPECT_FALSE(on_a_plane.stiffness().isZero(0.0));
  EXPECT_GT(smallest_eigenvalue(on_a_plane.stiffness()), -1.0e-12);
  ImplicitFriction in_a_corner;
  const Vector3 rounding(1.0e-20, -3.0e-21, 0.0);
  in_a_corner.begin(Matrix3::Identity(), Vector3::Zero(), rounding, impulse);
  const std::array<Support, 3> supports{Support{.normal = Vector3::UnitX(), .static_friction = 0.3, .friction = 0.3},
                                        Support{.normal = Vector3::UnitY(), .static_friction = 0.3, .friction = 0.3},
                                        Support{.normal = Vector3::UnitZ(), .static_friction = 0.3, .friction = 0.3}};
  in_a_corner.update(supports, Matrix3::Identity(), impulse, rounding);
  EXPECT_GT(in_a_corner.impulse().norm(), 0.0);
  EXPECT_GE(smallest_eigenvalue(in_a_corner.stiffness()), 0.0);
}

}  // namespace
}  // namespace sprung
