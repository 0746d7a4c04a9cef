#include "dynamics/numerics/block_cholesky.h"

#include "dynamics/dense_matrix.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <random>

namespace sprung {
namespace {

using Pairs = std::vector<ParticlePair>;

Pairs random_pairs(Index particles, Index count, std::mt19937& random) {
  std::uniform_int_distribution<Index> any(0, particles - 1);
  Pairs pairs;
  for (Index k = 0; k < count; ++k) {
    const ParticlePair pair{.first = any(random), .second = any(random)};
    if (pair.first != pair.second) pairs.push_back(pair);
  }
  return pairs;
}

/// Pairs of each particle with those up to two away along a row or column, or one along a diagonal.
Pairs cloth_pairs(Index side) {
  Pairs pairs;
  const auto add = [&](Index row, Index column, Index rows, Index columns) {
    if (row + rows >= side || column + columns >= side || column + columns < 0) return;
    pairs.push_back({.first = row * side + column, .second = (row + rows) * side + column + columns});
  };
  for (Index row = 0; row < side; ++row) {
    for (Index column = 0; column < side; ++column) {
      for (const auto& [rows, columns] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}})
        add(row, column, rows, columns);
    }
  }
  return pairs;
}

/// Masses between 1e-3 and 1 joined by springs of random directions and stiffness up to 1. Blocks between two particles are not
/// symmetric, like those of angle bends.
BlockMatrix random_matrix(Index particles, const Pairs& pairs, std::mt19937& random) {
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  const auto vector = [&] { return Vector3(between(random), between(random), between(random)); };
  BlockMatrix matrix(particles, pairs);
  for (Index i = 0; i < particles; ++i) matrix.add(i, i, std::pow(10.0, -3.0 * std::abs(between(random))) * Matrix3::Identity());
  for (const ParticlePair& pair : pairs) {
    const Vector3 a = vector();
    const Vector3 b = vector();
    matrix.add(pair.first, pair.first, a * a.transpose());
    matrix.add(pair.second, pair.second, b * b.transpose());
    matrix.add(pair.first, pair.second, a * b.transpose());
  }
  return matrix;
}

template <class Number>
constexpr double kEpsilon = std::numeric_limits<Number>::epsilon();

/// The residual of a factor of n columns is below (3 n + 1) eps | |L| |D| |L^T| | |x|, whose second norm is at most n |A| (Higham
/// 2002, theorems 10.4 and 10.5).
template <class Number>
void expect_solution(const Eigen::MatrixXd& matrix, const Scalars& right, const Scalars& solution) {
  const double n = static_cast<double>(matrix.rows());
  EXPECT_LE((matrix * solution - right).norm(), (3.0 * n + 1.0) * n * kEpsilon<Number> * matrix.norm() * solution.norm());
}

template <class Number>
void expect_raised(std::mt19937& random) {
  constexpr double kRaise = 0.5;
  const BlockMatrix matrix = random_matrix(40, random_pairs(40, 150, random), random);
  BlockCholesky<Number> factor(matrix);
  const Points right = Points::Random(3, 40);
  Points solution;
  ASSERT_TRUE(factor.factor_and_solve(matrix, kRaise, right, solution));
  Eigen::MatrixXd full = dense(matrix);
  full.diagonal() *= 1.0 + kRaise;
  expect_solution<Number>(full, right.reshaped(), solution.reshaped());
}

template <class Number>
void expect_solves(Index particles, const Pairs& pairs, std::mt19937& random) {
  const BlockMatrix matrix = random_matrix(particles, pairs, random);
  BlockCholesky<Number> factor(matrix);
  const Points right = Points::Random(3, particles);
  Points solution;
  ASSERT_TRUE(factor.factor_and_solve(matrix, 0.0, right, solution));
  const Eigen::MatrixXd full = dense(matrix);
  expect_solution<Number>(full, right.reshaped(), solution.reshaped());
  const Scalars expected = full.ldlt().solve(Scalars(right.reshaped()));
  // Both solutions have that residual, multiplied by the inverse, which the masses bound.
  const double n = 3.0 * particles;
  EXPECT_LE((solution.reshaped() - expected).norm(),
            2.0 * (3.0 * n + 1.0) * n * kEpsilon<Number> * full.norm() * expected.norm() / 1.0e-3);
}

/// In double and in single precision.
template <class Number>
class BlockCholeskyOf : public ::testing::Test {};
using Numbers = ::testing::Types<double, float>;
TYPED_TEST_SUITE(BlockCholeskyOf, Numbers);

TYPED_TEST(BlockCholeskyOf, SolvesRandomPatterns) {
  using Number = TypeParam;
  std::mt19937 random(1);
  for (const Index particles : {1, 2, 3, 5, 17, 60, 150}) {
    // From separate particles to nearly all pairs.
    for (const Index count : {0, particles / 2, particles, 3 * particles, 2 * particles * particles}) {
      expect_solves<Number>(particles, random_pairs(particles, count, random), random);
    }
  }
}

TYPED_TEST(BlockCholeskyOf, SolvesChainsAndCloths) {
  using Number = TypeParam;
  std::mt19937 random(2);
  for (const Index side : {2, 5, 12, 16}) expect_solves<Number>(side * side, cloth_pairs(side), random);
  Pairs chain;
  for (Index i = 0; i + 1 < 300; ++i) chain.push_back({.first = i, .second = i + 1});
  expect_solves<Number>(300, chain, random);
}

TYPED_TEST(BlockCholeskyOf, LeavesOutRowsAndColumns) {
  using Number = TypeParam;
  std::mt19937 random(3);
  const Index side = 9;
  const BlockMatrix matrix = random_matrix(side * side, cloth_pairs(side), random);
  std::vector<bool> left_out(side * side);
  for (Index i = 0; i < side * side; ++i) left_out[i] = i % 4 == 1;
  BlockCholesky<Number> factor(matrix, left_out);
  const Points right = Points::Random(3, side * side);
  Points solution = right;
  ASSERT_TRUE(factor.factor_and_solve(matrix, 0.0, solution, solution));
  Eigen::MatrixXd full = dense(matrix);
  Scalars known = right.reshaped();
  for (Index i = 0; i < side * side; ++i) {
    if (!left_out[i]) continue;
    full.middleRows<3>(3 * i).setZero();
    full.middleCols<3>(3 * i).setZero();
    full.block<3, 3>(3 * i, 3 * i).setIdentity();
    known.segment<3>(3 * i).setZero();
    EXPECT_EQ(solution.col(i), Vector3::Zero());
  }
  expect_solution<Number>(full, known, solution.reshaped());
}

TYPED_TEST(BlockCholeskyOf, AcceptsMatricesWithoutRows) {
  using Number = TypeParam;
  const BlockMatrix matrix(2, {});
  BlockCholesky<Number> factor(matrix, {true, true});
  Points vectors = Points::Ones(3, 2);
  ASSERT_TRUE(factor.factor_and_solve(matrix, 0.0, vectors, vectors));
  EXPECT_EQ(vectors, Points::Zero(3, 2));
  vectors = Points::Random(3, 2);
  factor.solve(vectors, vectors);
  EXPECT_EQ(vectors, Points::Zero(3, 2));
}

// An earlier matrix of the same object changes no bit of a later factor.
TYPED_TEST(BlockCholeskyOf, FactorsDoNotDependOnEarlierOnes) {
  using Number = TypeParam;
  std::mt19937 random(4);
  const Pairs pairs = cloth_pairs(10);
  const BlockMatrix first = random_matrix(100, pairs, random);
  const BlockMatrix second = random_matrix(100, pairs, random);
  const Points right = Points::Random(3, 100);
  BlockCholesky<Number> used(first);
  Points after_used;
  ASSERT_TRUE(used.factor_and_solve(first, 0.0, right, after_used));
  ASSERT_TRUE(used.factor_and_solve(second, 0.0, right, after_used));
  BlockCholesky<Number> fresh(first);
  Points after_fresh;
  ASSERT_TRUE(fresh.factor_and_solve(second, 0.0, right, after_fresh));
  EXPECT_EQ(after_used, after_fresh);
}

TYPED_TEST(BlockCholeskyOf, SolvesAgainWithTheSameBits) {
  using Number = TypeParam;
  std::mt19937 random(13);
  const BlockMatrix matrix = random_matrix(100, cloth_pairs(10), random);
  const Points right = Points::Random(3, 100);
  std::vector<bool> left_out(100, false);
  left_out[0] = left_out[57] = true;
  BlockCholesky<Number> factor(matrix, left_out);
  Points expected;
  ASSERT_TRUE(factor.factor_and_solve(matrix, 0.01, right, expected));
  Points solution;
  factor.solve(Points::Random(3, 100), solution);
  EXPECT_NE(solution, expected);
  factor.solve(right, solution);
  EXPECT_EQ(solution, expected);
}

TYPED_TEST(BlockCholeskyOf, KeepsTheSolutionOfAMatrixThatItRefuses) {
  using Number = TypeParam;
  std::mt19937 random(13);
  BlockMatrix matrix = random_matrix(100, cloth_pairs(10), random);
  BlockCholesky<Number> factor(matrix);
  matrix.add(27, 27, Matrix3::Constant(std::numeric_limits<double>::quiet_NaN()));
  const Points right = Points::Random(3, 100);
  Points solution = right;
  EXPECT_FALSE(factor.factor_and_solve(matrix, 0.01, solution, solution));
  EXPECT_EQ(solution, right);
}

TYPED_TEST(BlockCholeskyOf, RefusesMatricesThatAreNotPositiveDefinite) {
  using Number = TypeParam;
  std::mt19937 random(5);
  const Pairs pairs = cloth_pairs(8);
  for (const Index particle : {0, 27, 63}) {
    const BlockMatrix sound = random_matrix(64, pairs, random);
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(sound), Eigen::EigenvaluesOnly).eigenvalues()[0];
    BlockMatrix shifted = sound;
    BlockCholesky<Number> factor(sound);
    const Points right = Points::Random(3, 64);
    Points solution;
    const auto accepts = [&](const BlockMatrix& matrix) { return factor.factor_and_solve(matrix, 0.0, right, solution); };
    // All eigenvalues decrease by the same amount.
    for (Index i = 0; i < 64; ++i) shifted.add(i, i, -0.99 * least * Matrix3::Identity());
    EXPECT_TRUE(accepts(shifted));
    for (Index i = 0; i < 64; ++i) shifted.add(i, i, -0.02 * least * Matrix3::Identity());
    EXPECT_FALSE(accepts(shifted));
    BlockMatrix broken = sound;
    broken.add(particle, particle, Matrix3::Constant(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(accepts(broken));
    EXPECT_TRUE(accepts(sound));
  }
}

TYPED_TEST(BlockCholeskyOf, PowersOfTwoScaleItExactly) {
  using Number = TypeParam;
  std::mt19937 random(6);
  const Pairs pairs = cloth_pairs(9);
  const BlockMatrix matrix = random_matrix(81, pairs, random);
  const Points right = Points::Random(3, 81);
  BlockCholesky<Number> factor(matrix);
  Points expected;
  ASSERT_TRUE(factor.factor_and_solve(matrix, 0.0, right, expected));
  // Scales far beyond the range of a float too.
  for (const int of_matrix : {-31, 0, -180, 180}) {
    for (const int of_right : {0, -180, 180}) {
      BlockMatrix scaled(81, pairs);
      scaled.add_scaled(matrix, std::ldexp(1.0, of_matrix));
      Points solution;
      ASSERT_TRUE(factor.factor_and_solve(scaled, 0.0, std::ldexp(1.0, of_right) * right, solution)) << of_matrix;
      EXPECT_EQ(solution, std::ldexp(1.0, of_right - of_matrix) * expected) << of_matrix << ", " << of_right;
    }
  }
}

TEST(BlockCholesky, RaisesTheDiagonal) {
  std::mt19937 random(12);
  expect_raised<double>(random);
  expect_raised<float>(random);
}

}  // namespace
}  // namespace sprung
