// Sparse factors of a cloth's equations: supernodal L D L^T of 3 x 3 blocks in double and in single precision, and Eigen's
// simplicial L D L^T of scalars in the same run.
#include "benchmark/processor_time.h"
#include "dynamics/numerics/block_cholesky.h"
#include "network/network_builder.h"

#include <benchmark/benchmark.h>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <limits>
#include <random>

namespace sprung::benchmarks {
namespace {

constexpr int kRepeats = 5;

enum Springs : std::uint8_t { structural, all };

/// Small masses joined by springs of random directions, like those of a crumpled cloth.
BlockMatrix cloth_matrix(Index side, Springs kinds) {
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = 1.0};
  if (kinds == all) materials.shear = materials.bend = SpringMaterial{.value = 1.0};
  const BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {side, side}}, materials);
  std::vector<ParticlePair> pairs;
  for (Index s = 0; s < shape.springs.count(); ++s)
    pairs.push_back({.first = shape.springs.first[s], .second = shape.springs.second[s]});
  BlockMatrix matrix(side * side, pairs);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (Index i = 0; i < matrix.size(); ++i) matrix.add(i, i, 1.0e-3 * Matrix3::Identity());
  for (const ParticlePair& pair : pairs) {
    const Vector3 along = Vector3(normal(random), normal(random), normal(random)).normalized();
    matrix.add_difference(pair.first, pair.second, 0.1 * Matrix3::Identity() + along * along.transpose());
  }
  return matrix;
}

Eigen::SparseMatrix<double> scalar_matrix(const BlockMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index row, Index column, const Matrix3& block) {
    for (Index c = 0; c < 3; ++c) {
      for (Index r = row == column ? c : 0; r < 3; ++r) entries.emplace_back(3 * row + r, 3 * column + c, block(r, c));
    }
  };
  for (Index j = 0; j < matrix.size(); ++j) {
    add(j, j, matrix.diagonal(j));
    matrix.for_column(j, [&](Index i, const Matrix3& block) { add(i, j, block); });
  }
  Eigen::SparseMatrix<double> scalars(3 * matrix.size(), 3 * matrix.size());
  scalars.setFromTriplets(entries.begin(), entries.end());
  return scalars;
}

template <class Work>
double best_time(const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const double begin = processor_time();
    work();
    best = std::min(best, processor_time() - begin);
  }
  return best;
}

struct FactorTimes {
  double factor_and_solve = 0.0;  ///< [s]
  double solve = 0.0;             ///< [s]
};

template <class Number>
FactorTimes time_blocks(const BlockMatrix& matrix, const Points& right) {
  BlockCholesky<Number> blocks(matrix);
  Points solution;
  const double factor_and_solve =
      best_time([&] { benchmark::DoNotOptimize(blocks.factor_and_solve(matrix, 0.0, right, solution)); });
  return {.factor_and_solve = factor_and_solve, .solve = best_time([&] { blocks.solve(right, solution); })};
}

/// Arguments: particles along a side, springs. The time is one factor_and_solve() in double precision.
void factor_against_eigen(benchmark::State& state) {
  const BlockMatrix matrix = cloth_matrix(static_cast<Index>(state.range(0)), static_cast<Springs>(state.range(1)));
  const Points right = Points::Random(3, matrix.size());
  Points solution(3, matrix.size());
  const Eigen::SparseMatrix<double> scalars = scalar_matrix(matrix);
  for ([[maybe_unused]] auto _ : state) {
    const FactorTimes blocks = time_blocks<double>(matrix, right);
    const FactorTimes single_blocks = time_blocks<float>(matrix, right);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> eigen;
    eigen.analyzePattern(scalars);
    const double eigen_factor = best_time([&] { eigen.factorize(scalars); });
    const double eigen_solve = best_time([&] { solution.reshaped() = eigen.solve(right.reshaped()); });
    state.SetIterationTime(blocks.factor_and_solve);
    state.counters["solve_ms"] = 1e3 * blocks.solve;
    state.counters["single_factor_and_solve_ms"] = 1e3 * single_blocks.factor_and_solve;
    state.counters["single_solve_ms"] = 1e3 * single_blocks.solve;
    state.counters["factor_and_solve_of_eigen"] = blocks.factor_and_solve / (eigen_factor + eigen_solve);
    state.counters["solve_of_eigen"] = blocks.solve / eigen_solve;
  }
}

BENCHMARK(factor_against_eigen)
    ->ArgNames({"side", "all_springs"})
    ->ArgsProduct({{32, 64, 128}, {structural, all}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sprung::benchmarks
