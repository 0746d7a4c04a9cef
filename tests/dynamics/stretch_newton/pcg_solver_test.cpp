#include "dynamics/stretch_newton/pcg_solver.h"

#include "dynamics/dense_matrix.h"
#include "dynamics/networks.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <random>

namespace sprung {
namespace {

/// The solver for a cloth whose links have random directions.
class PcgSolverOfACloth : public ::testing::Test {
 protected:
  /// Links are at most `stiffness` times as stiff as the largest mass; a fifth of them is slack.
  [[nodiscard]] StretchSystem system(double stiffness) {
    std::normal_distribution<double> normal;
    StretchSystem system;
    system.residual = Points::NullaryExpr(3, component_.free_count, [&] { return normal(random_); });
    for (std::size_t s = 0; s < component_.links.size(); ++s) {
      const Vector3 direction = Vector3(normal(random_), normal(random_), normal(random_)).normalized();
      const double stiff = s % 5 == 0 ? 0.0 : stiffness * component_.masses.front();
      system.blocks.push_back(SymmetricMatrix3::along(1.0e-3 * stiff, stiff, direction));
    }
    return system;
  }

  /// The gain that another step than `step` could still make, as a fraction of the whole gain.
  [[nodiscard]] double fraction_left(const StretchSystem& system, const Points& step) const {
    const Eigen::MatrixXd full = dense(component_, system);
    const Eigen::LDLT<Eigen::MatrixXd> exact(full);
    const Scalars right = system.residual.reshaped();
    const Scalars left = right - full * step.reshaped();
    return left.dot(exact.solve(left)) / right.dot(exact.solve(right));
  }

  SpringNetwork network_ = make_test_cloth(9, 0.0, 0.0);
  StretchComponent component_ = stretch_components(network_, {SpringKind::structural}).front();
  PcgSolver solver_{component_};
  std::mt19937 random_{3};
};

// A hundredth of the energy, measured by the factor, may remain. Single precision works up to a stiffness of about 1e7 times the
// masses. Beyond that double precision must take over, and must not prevent later solves of softer systems.
TEST_F(PcgSolverOfACloth, SolvesAtAnyStiffness) {
  for (const double stiffness : {1.0, 1.0e3, 1.0e5, 1.0e7, 1.0e8, 1.0e9, 1.0e11, 1.0e8, 1.0e2}) {
    const StretchSystem equations = system(stiffness);
    Points step;
    solver_.solve(equations, step);
    EXPECT_LT(fraction_left(equations, step), 0.01) << stiffness;
  }
}

// The kept factor, in either precision, is that of the previous system; conjugate gradients converge from it.
TEST_F(PcgSolverOfACloth, ReusesTheLastFactorForASimilarSystem) {
  for (const double stiffness : {1.0e3, 1.0e11}) {
    StretchSystem equations = system(stiffness);
    Points step;
    solver_.solve(equations, step);
    for (SymmetricMatrix3& block : equations.blocks) block += SymmetricMatrix3::along(0.05 * block.xx, 0.0, Vector3::UnitX());
    equations.is_like_last = true;
    solver_.solve(equations, step);
    EXPECT_LT(fraction_left(equations, step), 0.02) << stiffness;
  }
}

// One application of a factor is accurate enough in either precision: the rounding for 1e3 times the mass is negligible in both.
TEST_F(PcgSolverOfACloth, SolvesAgainForAnotherResidual) {
  for (const double stiffness : {1.0e3, 1.0e11}) {
    StretchSystem equations = system(stiffness);
    Points step;
    solver_.solve(equations, step);
    equations.residual = Points::Random(3, component_.free_count);
    solver_.solve_again(equations, step);
    EXPECT_LT(fraction_left(equations, step), 0.01) << stiffness;
  }
}

// After a system without a factor nothing can be solved with.
TEST_F(PcgSolverOfACloth, ReturnsZeroWithoutAFactor) {
  StretchSystem equations = system(1.0e3);
  equations.blocks.front().xx = std::numeric_limits<double>::quiet_NaN();
  Points step;
  solver_.solve(equations, step);
  solver_.solve_again(system(1.0e3), step);
  EXPECT_EQ(step, Points::Zero(3, component_.free_count));
}

// A free component receives all of its momentum, whatever the remaining error: to the rounding of double precision.
TEST(PcgSolver, KeepsMomentum) {
  const SpringNetwork network = make_test_cloth(6, 0.0, 0.0, false);
  const StretchComponent component = stretch_components(network, {SpringKind::structural}).front();
  StretchSystem system;
  system.residual = Points::Random(3, component.free_count);
  system.blocks.assign(component.links.size(), SymmetricMatrix3::along(0.0, 1.0e3, Vector3::UnitX()));
  Points step;
  const auto expect_momentum = [&] {
    Vector3 momentum = Vector3::Zero();
    for (Index i = 0; i < component.free_count; ++i) momentum += component.masses[i] * step.col(i);
    EXPECT_LT((momentum - system.residual.rowwise().sum()).norm(), 1.0e-13 * system.residual.cwiseAbs().sum());
  };
  PcgSolver solver(component);
  solver.solve(system, step);
  expect_momentum();
  system.residual = Points::Random(3, component.free_count);
  solver.solve_again(system, step);
  expect_momentum();
}

TEST_F(PcgSolverOfACloth, IsNotFiniteWhereTheSystemIsNot) {
  StretchSystem equations = system(1.0e3);
  equations.blocks.front().xx = std::numeric_limits<double>::quiet_NaN();
  Points step;
  solver_.solve(equations, step);
  EXPECT_FALSE(step.allFinite());
  const StretchSystem sound = system(1.0e3);
  solver_.solve(sound, step);
  EXPECT_LT(fraction_left(sound, step), 0.01);
}

}  // namespace
}  // namespace sprung
