#include "dynamics/constraints/cell_volume.h"

#include "dynamics/constraints/same_bits.h"
#include "network/network_builder.h"
#include "network/total_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace sprung {
namespace {

/// A cube of hexahedra or, each cut into five, of tetrahedra, whose particles have different masses.
SpringNetwork cube(Index resolution, bool tetrahedra) {
  BodyShape solid = make_solid({.resolution = {resolution, resolution, resolution}}, {});
  set_total_mass(solid, 1.0);
  for (std::size_t i = 0; i < solid.masses.size(); ++i) solid.masses[i] *= 1.0 + 0.1 * static_cast<double>(i % 7);
  solid.preserve_volume = true;
  if (tetrahedra) {
    // The two ways to cut a cell alternate like the squares of a chessboard, so that neighbours agree about the diagonals.
    const Index cells = resolution - 1;
    for (std::size_t h = 0; h < solid.cells.hexahedra.size(); ++h) {
      const auto number = static_cast<Index>(h);
      const bool odd = (number % cells + number / cells % cells + number / (cells * cells)) % 2 == 1;
      const std::array<std::size_t, 5> parts =
          odd ? std::array<std::size_t, 5>{1, 2, 4, 7, 9} : std::array<std::size_t, 5>{0, 3, 5, 6, 8};
      for (const std::size_t part : parts) {
        Tetrahedron& cell = solid.cells.tetrahedra.emplace_back();
        for (std::size_t c = 0; c < 4; ++c) cell[c] = solid.cells.hexahedra[h][kTetrahedraOfHexahedron[part][c]];
      }
    }
    solid.cells.hexahedra.clear();
  }
  NetworkBuilder builder;
  builder.add_body("cube", solid);
  return builder.build();
}

Points shaken(const SpringNetwork& network, double amplitude) {
  std::mt19937 random(7);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same positions in every run are intended
  std::uniform_real_distribution<double> offset(-amplitude, amplitude);
  Points positions = network.positions;
  for (double& coordinate : positions.reshaped()) coordinate += offset(random);
  return positions;
}

class CellVolumeOf : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Cells, CellVolumeOf, ::testing::Bool(),
                         [](const auto& instance) { return instance.param ? "Tetrahedra" : "Hexahedra"; });

TEST_P(CellVolumeOf, ARestShapeStays) {
  const SpringNetwork network = cube(4, GetParam());
  const CellVolume volume(network);
  Points positions = network.positions;
  EXPECT_NEAR(volume.project(network.positions, positions, {}), 0.0, 1.0e-11);
  EXPECT_LT((positions - network.positions).cwiseAbs().maxCoeff(), 1.0e-15);
}

TEST_P(CellVolumeOf, PassesRestoreTheVolumeAndConserveMomentum) {
  const SpringNetwork network = cube(4, GetParam());
  const CellVolume volume(network);
  Points positions = 0.8 * network.positions;
  const Vector3 center = positions * network.masses;
  Vector3 moment = Vector3::Zero();
  for (int pass = 0; pass < 200 && volume.residual(positions) > 1.0; ++pass) {
    const Points before = positions;
    volume.project(network.positions, positions, {});
    for (Index i = 0; i < network.particle_count(); ++i) {
      const Vector3 moved = positions.col(i) - before.col(i);
      moment += network.masses[i] * Vector3(before.col(i)).cross(moved);
    }
  }
  EXPECT_LE(volume.residual(positions), 1.0);
  const Cells& cells = network.bodies[0].cells;
  EXPECT_NEAR(testing::total_volume(cells, positions), 1.0, 0.01);  // no region is off by more
  EXPECT_LT((positions * network.masses - center).norm(), 1.0e-13);
  // A pass moves one region after the other, so `before` is not where a region started: the moment is of the order of the square of
  // the motion, here 0.1 of the extent at most, and far below what one-sided motion would give.
  EXPECT_LT(moment.norm(), 0.01);
}

TEST_P(CellVolumeOf, PassesTurnInvertedCellsBack) {
  const SpringNetwork network = cube(4, GetParam());
  const CellVolume volume(network);
  const Cells& cells = network.bodies[0].cells;
  Points positions = shaken(network, 0.25);  // cells are 1/3 wide
  ASSERT_GT(count_inverted(cells, positions), 5);
  for (int pass = 0; pass < 100; ++pass) volume.project(network.positions, positions, {});
  EXPECT_EQ(count_inverted(cells, positions), 0);
}

TEST_P(CellVolumeOf, PinnedParticlesStay) {
  SpringNetwork network = cube(3, GetParam());
  for (Index i = 0; i < 9; ++i) network.inverse_masses[i] = 0.0;
  const CellVolume volume(network);
  Points positions = 0.9 * network.positions;
  const Points start = positions;
  volume.project(network.positions, positions, {});
  EXPECT_EQ(positions.leftCols(9), start.leftCols(9));
  EXPECT_NE(positions.rightCols(9), start.rightCols(9));
}

// Eight cells at a time, and cell by cell while pins record.
TEST_P(CellVolumeOf, RecordingImpulsesChangesNoBits) {
  SpringNetwork network = cube(9, GetParam());
  for (Index i = 0; i < network.particle_count(); i += 40) network.inverse_masses[i] = 0.0;
  CellVolume volume(network);
  Points positions = shaken(network, 0.02);
  Points recorded = positions;
  volume.project(network.positions, positions, {});
  RecordedImpulses impulses{.on_pinned = Points::Zero(3, network.particle_count()), .of_springs = {}};
  volume.project(network.positions, recorded, ImpulseRecorder(impulses, 0.01));
  EXPECT_EQ(recorded, positions);
  EXPECT_FALSE(impulses.on_pinned.isZero(0.0));
}

// More tetrahedra around an edge than a region holds.
TEST(CellVolume, AFanOfManyTetrahedraIsKept) {
  constexpr Index kBlades = 300;
  BodyShape fan;
  fan.positions = {{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  for (Index b = 0; b < kBlades; ++b) {
    const double angle = 2.0 * std::numbers::pi * b / kBlades;
    fan.positions.emplace_back(std::cos(angle), std::sin(angle), 0.5);
    fan.cells.tetrahedra.push_back({0, 2 + b, 2 + (b + 1) % kBlades, 1});
  }
  fan.velocities.assign(fan.positions.size(), Vector3::Zero());
  fan.drag_areas.assign(fan.positions.size(), 0.0);
  set_total_mass(fan, 1.0);
  fan.preserve_volume = true;
  NetworkBuilder builder;
  builder.add_body("fan", fan);
  const SpringNetwork network = builder.build();
  const CellVolume volume(network);
  Points positions = 0.9 * network.positions;
  for (int pass = 0; pass < 500 && volume.residual(positions) > 1.0; ++pass) volume.project(network.positions, positions, {});
  EXPECT_LE(volume.residual(positions), 1.0);
}

// A chunk has 128 regions, and colours hold a thirtieth of them.
TEST_P(CellVolumeOf, BitsDoNotDependOnThreads) {
  const SpringNetwork network = cube(22, GetParam());
  testing::expect_same_bits(CellVolume(network), shaken(network, 0.03));
}

}  // namespace
}  // namespace sprung
