#include "dynamics/stretch_limit/stretch_kernel.h"

#include "base/machine/kernel.h"
#include "base/machine/simd.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace sprung {
namespace {

const std::vector<SpringKind> kStructural{SpringKind::structural};

/// A network of springs between random particles that the batches store in all layouts: between two rows, and between neighbours
/// and arbitrary particles. Some ends are pinned, some springs have no length, and unless `same` each has its own constants.
SpringNetwork springs_of_all_layouts(Index row, bool same, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.1, 1.0);
  NetworkBuilder builder;
  const Index count = 4 * row;
  Vector3 position = Vector3::Zero();
  for (Index i = 0; i < count; ++i) {
    const bool stays = random() % 16 == 0;  // at the position of the previous one
    if (!stays) position = Vector3(unit(random), unit(random), unit(random));
    builder.add_particle(position, same ? 1.0 : unit(random));
    if (random() % 16 == 0) builder.pin(i);
  }
  const auto add = [&](Index a, Index b) { builder.add_spring(a, b, 0.0, same ? 0.5 : unit(random)); };
  for (Index i = 0; i < row; ++i) add(i, row + i);                        // runs
  for (Index i = 0; i + 1 < row; ++i) add(2 * row + i, 2 * row + i + 1);  // gathered, in two colours
  for (Index i = 0; i < row; ++i) {
    const auto a = static_cast<Index>(random() % static_cast<unsigned>(count));
    const auto b = static_cast<Index>(random() % static_cast<unsigned>(count));
    if (a != b) add(a, b);
  }
  return builder.build();
}

/// One pass, spring by spring, with the machine's own square root. Returns the largest excess before the projection.
double project_by_hand(const SpringNetwork& network, const SpringBatches& batches, const LengthRange& range, double relaxation,
                       const Points& before, Points& x) {
  double excess = 0.0;
  for (Index s = 0; s < batches.count(); ++s) {
    const Index a = batches.first[s];
    const Index b = batches.second[s];
    if (s % kSimdWidth > 0 && batches.first[s - 1] == a && batches.second[s - 1] == b) continue;  // fills a group
    const Vector3 between = x.col(b) - x.col(a);
    const double length = between.norm();
    const double allowed = std::clamp(length, range.least * batches.rest_length[s], range.most * batches.rest_length[s]);
    excess = std::max(excess, std::abs(length - allowed) / batches.rest_length[s]);
    const double weight_a = network.inverse_masses[a] / (network.inverse_masses[a] + network.inverse_masses[b]);
    Vector3 correction = Vector3::Zero();
    if (length > allowed) correction = relaxation * (length - allowed) / length * between;
    if (length < allowed) correction = -relaxation * std::min(allowed / length - 1.0, 1.0) * (before.col(b) - before.col(a));
    x.col(a) += weight_a * correction;
    x.col(b) -= (1.0 - weight_a) * correction;
  }
  return excess;
}

/// Earlier positions, from which springs have rotated and stretched since.
Points earlier_positions(const Points& x, std::mt19937& random) {
  std::uniform_real_distribution<double> displacement(-0.1, 0.1);
  return x.unaryExpr([&](double coordinate) { return coordinate + displacement(random); });
}

constexpr std::array<LengthRange, 4> kRanges{{{0.0, 1.02}, {1.0, 1.0}, {0.8, 1.1}, {0.0, 4.0}}};

TEST(StretchKernel, AgreesWithPlainCode) {
  std::mt19937 random(11);
  std::array<Index, 2> layouts{};
  for (Index row = 2; row < 80; ++row) {
    const SpringNetwork network = springs_of_all_layouts(row, row % 2 == 0, random);
    const SpringBatches batches(network, kStructural);
    for (const SpringBatches::Batch& batch : batches.batch) ++layouts[static_cast<std::size_t>(batch.layout)];
    const BatchRange all{0, static_cast<Index>(batches.batch.size())};
    for (const LengthRange& range : kRanges) {
      for (const double relaxation : {1.0, 1.8}) {
        Points x = network.positions;
        Points expected = x;
        const Points before = earlier_positions(x, random);
        const double excess = project_by_hand(network, batches, range, relaxation, before, expected);
        const SquaredLengths measured = project_springs_narrow(batches, all, range, relaxation, before.data(), x.data());
        // Springs are at most 10 times their rest length and rounded a few times each; a particle has a dozen of them, which pass
        // the error on.
        EXPECT_NEAR(measured.excess(range), excess, 1.0e-13) << row;
        EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1.0e-13) << row;
      }
    }
  }
  for (const Index count : layouts) EXPECT_GT(count, 0);
}

// On a machine with AVX-512 the chosen kernel has twice as many lanes.
TEST(StretchKernel, GivesTheSameBitsWithAnyLaneCount) {
  if (!has_wide_lanes()) GTEST_SKIP() << "this machine has no AVX-512, so both are the same code";
  std::mt19937 random(12);
  for (Index row = 2; row < 80; ++row) {
    const SpringNetwork network = springs_of_all_layouts(row, row % 2 == 0, random);
    const SpringBatches batches(network, kStructural);
    const BatchRange all{0, static_cast<Index>(batches.batch.size())};
    for (const LengthRange& range : kRanges) {
      Points narrow = network.positions;
      Points chosen = network.positions;
      const Points before = earlier_positions(narrow, random);
      const SquaredLengths measured_narrow = project_springs_narrow(batches, all, range, 1.0, before.data(), narrow.data());
      const SquaredLengths measured_chosen = project_springs(batches, all, range, 1.0, before.data(), chosen.data());
      EXPECT_EQ(narrow, chosen) << row;
      EXPECT_EQ(measured_narrow.excess(range), measured_chosen.excess(range)) << row;
      EXPECT_EQ(measure_springs_narrow(batches, all, narrow.data()).excess(range),
                measure_springs(batches, all, chosen.data()).excess(range));
    }
  }
}

TEST(StretchKernel, MeasuresTheLongestAndTheShortest) {
  std::mt19937 random(13);
  for (const Index row : {3, 9, 33, 70}) {
    const SpringNetwork network = springs_of_all_layouts(row, false, random);
    const SpringBatches batches(network, kStructural);
    SquaredLengths expected;
    for (Index s = 0; s < batches.count(); ++s) {
      const double length = (network.positions.col(batches.first[s]) - network.positions.col(batches.second[s])).norm();
      const double relative = length / batches.rest_length[s];
      expected.include({relative * relative, relative * relative});
    }
    const BatchRange all{0, static_cast<Index>(batches.batch.size())};
    const SquaredLengths measured = measure_springs(batches, all, network.positions.data());
    // The tolerance is a few roundings of each.
    EXPECT_NEAR(measured.longest, expected.longest, 1.0e-14 * expected.longest);
    EXPECT_NEAR(measured.shortest, expected.shortest, 1.0e-14 * expected.shortest);
  }
}

TEST(StretchKernel, LeavesSpringsWithinTheirLimitsUnchangedBitForBit) {
  std::mt19937 random(14);
  const SpringNetwork network = springs_of_all_layouts(70, false, random);
  const SpringBatches batches(network, kStructural);
  Points x = network.positions;
  const BatchRange all{0, static_cast<Index>(batches.batch.size())};
  project_springs(batches, all, {0.0, 100.0}, 1.0, network.velocities.data(), x.data());
  EXPECT_EQ(x, network.positions);
}

}  // namespace
}  // namespace sprung
