#include "network/bodies/body_shape.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

constexpr double kSide = 0.5;

/// A bar of 4 x 2 x 2 cells that carries two triangles.
LatticeShape bar(double fraction) {
  LatticeShape lattice;
  lattice.surface.vertices = (Points(3, 4) << 0.1, 1.9, 0.6, 1.5, 0.1, 0.2, 0.9, 0.75, 0.1, 0.3, 0.5, 0.75).finished();
  lattice.surface.faces = to_polygons((Triangles(3, 2) << 0, 1, 1, 3, 2, 2).finished());
  lattice.surface.lines.resize(2, 0);
  lattice.contact = {lattice.surface.vertices, triangulate(lattice.surface.faces)};
  lattice.cell_size = kSide;
  for (Index i = 0; i < 16; ++i) lattice.cells.push_back({{i % 4, i / 4 % 2, i / 8}, fraction});
  return lattice;
}

SpringMaterials structural(double modulus) {
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = modulus, .measure = SpringMaterial::Measure::modulus};
  return materials;
}

TEST(LatticeBody, VerticesLieWhereTheirCellsCarryThem) {
  const LatticeShape lattice = bar(1.0);
  const BodyShape body = make_lattice_body(lattice, {});
  ASSERT_EQ(body.carried.size(), 4U);
  EXPECT_EQ(body.positions.size(), 4U + 5 * 3 * 3);
  for (std::size_t v = 0; v < body.carried.size(); ++v) {
    Vector3 sum = Vector3::Zero();
    double weights = 0.0;
    for (std::size_t c = 0; c < 8; ++c) {
      EXPECT_GE(body.carried[v].weights[c], 0.0);
      weights += body.carried[v].weights[c];
      sum += body.carried[v].weights[c] * body.positions[body.carried[v].corners[c]];
    }
    EXPECT_NEAR(weights, 1.0, 1.0e-15);
    EXPECT_LT((sum - lattice.surface.vertices.col(static_cast<Index>(v))).norm(), 1.0e-15);
  }
}

TEST(LatticeBody, MassIsThatOfTheFractionsAndEveryParticleHasSome) {
  BodyShape body = make_lattice_body(bar(0.5), {});
  set_density(body, 1000.0);
  EXPECT_NEAR(std::accumulate(body.masses.begin(), body.masses.end(), 0.0), 1000.0 * 0.5 * 2.0, 1.0e-9);
  for (const double mass : body.masses) EXPECT_GT(mass, 0.0);
  set_total_mass(body, 3.0);
  EXPECT_NEAR(std::accumulate(body.masses.begin(), body.masses.end(), 0.0), 3.0, 1.0e-12);
  EXPECT_NE(body.masses.front(), body.masses.back()) << "in proportion to the volume";
}

// A corner of the bar belongs to one cell, an eighth of which is nearest to it.
TEST(LatticeBody, ACornerGivesHalfOfItsMassToTheVerticesThatItCarries) {
  const BodyShape body = make_lattice_body(bar(1.0), {});
  constexpr double kOfCorner = kSide * kSide * kSide / 8.0;
  EXPECT_GT(body.carried[0].weights[0], 0.0);
  EXPECT_DOUBLE_EQ(body.measures[body.carried[0].corners[0]], 0.5 * kOfCorner);
  const auto corner_at = [&](const Vector3& place) {
    return static_cast<std::size_t>(std::find(body.positions.begin() + 4, body.positions.end(), place) - body.positions.begin());
  };
  EXPECT_DOUBLE_EQ(body.measures[corner_at({2.0, 1.0, 0.0})], kOfCorner) << "its cell carries no vertex";
}

// Each cell gives a quarter of its cross-section to each of its four edges along the bar, so the sum over a cut is that of the bar.
TEST(LatticeBody, APulledBarHasTheStiffnessOfItsMaterial) {
  for (const double fraction : {1.0, 0.25}) {
    const BodyShape body = make_lattice_body(bar(fraction), structural(8.0));
    double through_cut = 0.0;
    for (Index s = 0; s < body.springs.count(); ++s) {
      const Vector3& a = body.positions[body.springs.first[s]];
      const Vector3& b = body.positions[body.springs.second[s]];
      if (std::min(a.x(), b.x()) == 2 * kSide && std::max(a.x(), b.x()) == 3 * kSide) through_cut += body.springs.stiffness[s];
    }
    EXPECT_NEAR(through_cut, fraction * 8.0 * 1.0 / kSide, 1.0e-12);
  }
}

TEST(LatticeBody, OfABoxHasTheSpringsOfASolid) {
  SpringMaterials materials = structural(8.0);
  materials.shear = SpringMaterial{.value = 3.0, .measure = SpringMaterial::Measure::modulus};
  const BodyShape lattice = make_lattice_body(bar(1.0), materials);
  const BodyShape solid = make_solid({.size = {2.0, 1.0, 1.0}, .resolution = {5, 3, 3}}, materials);
  ASSERT_EQ(lattice.springs.count(), solid.springs.count());
  std::vector<double> a = lattice.springs.stiffness;
  std::vector<double> b = solid.springs.stiffness;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  for (std::size_t s = 0; s < a.size(); ++s) EXPECT_NEAR(a[s], b[s], 1.0e-12);
}

}  // namespace
}  // namespace sprung
