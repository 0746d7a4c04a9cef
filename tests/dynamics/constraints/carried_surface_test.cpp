#include "dynamics/constraints/carried_surface.h"

#include "dynamics/constraints/same_bits.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <random>

namespace sprung {
namespace {

/// A cube of 1 m with this number of cells along its sides that carries vertices at random places.
SpringNetwork cube(Index cells = 4, Index vertices = 200) {
  std::mt19937 random(3);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same places in every run are intended
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  LatticeShape lattice;
  lattice.surface.vertices = Points(3, vertices).unaryExpr([&](double /*unused*/) { return coordinate(random); });
  lattice.surface.faces = to_polygons(Triangles(3, 0));
  lattice.surface.lines.resize(2, 0);
  lattice.contact = {lattice.surface.vertices, Triangles(3, 0)};
  lattice.cell_size = 1.0 / cells;
  for (Index i = 0; i < cells * cells * cells; ++i) {
    lattice.cells.push_back({{i % cells, i / cells % cells, i / (cells * cells)}, 1.0});
  }
  BodyShape body = make_lattice_body(lattice, {});
  set_density(body, 1.0);
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);  // so that numbers within the body differ from those of the network
  builder.add_body("cube", body);
  return builder.build();
}

TEST(CarriedSurface, MovesWithItsCells) {
  const SpringNetwork network = cube();
  const CarriedSurface surface(network);
  EXPECT_LT(surface.residual(network.positions), 1.0e-9);
  // Any affine motion of all keeps weighted sums, up to rounding in units of a thousandth of a cell.
  Matrix3 shear;
  shear << 1.2, 0.1, 0.0, -0.3, 0.9, 0.2, 0.0, 0.4, 1.1;
  EXPECT_LT(surface.residual(shear * network.positions), 1.0e-9);
}

TEST(CarriedSurface, PassesBringPushedVerticesBackAndConserveMomentum) {
  const SpringNetwork network = cube();
  const CarriedSurface surface(network);
  Points positions = network.positions;
  for (Index v = 1; v <= 200; v += 3) positions.col(v) += Vector3(0.0, 0.05, 0.02);
  const Vector3 center = positions * network.masses;
  const Vector3 at_rest = network.positions * network.masses;
  const double before = surface.residual(positions);
  for (int pass = 0; pass < 100 && surface.residual(positions) > 1.0; ++pass) surface.project(network.positions, positions, {});
  EXPECT_GT(before, 10.0);
  EXPECT_LE(surface.residual(positions), 1.0);
  EXPECT_LT((positions * network.masses - center).norm(), 1.0e-14);
  // What vertices gave up, cells took.
  const auto cells = [&](const Points& x) -> Vector3 { return x.rightCols(125) * network.masses.tail(125); };
  EXPECT_GT((cells(positions) - cells(network.positions)).dot(center - at_rest), 0.3 * (center - at_rest).squaredNorm());
}

// A chunk has 64 cells, and colours hold an eighth of them.
TEST(CarriedSurface, BitsDoNotDependOnThreads) {
  const SpringNetwork network = cube(16, 8000);
  Points pushed = network.positions;
  for (Index v = 1; v <= 8000; v += 2) pushed.col(v) += Vector3(0.01, -0.05, 0.02);
  testing::expect_same_bits(CarriedSurface(network), pushed);
}

}  // namespace
}  // namespace sprung
