#include "network/bodies/tetrahedra_body.h"

#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tetrahedra/box_meshes.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include <limits>
#include <numeric>
#include <set>

namespace sprung {
namespace {

using namespace testing;
using test::Cut;
using test::make_box;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kModulus = 2e4;

/// Force [N] on the end of a bar along x whose ends are clamped, relative to E A times the strain. It solves the linear system of
/// the springs: small strains have a linear answer.
double relative_stiffness(const BodyShape& bar, double length, double area) {
  const auto n = static_cast<Index>(bar.positions.size());
  std::vector<Index> unknown(bar.positions.size(), kNone);  // the first of three
  Index unknowns = 0;
  for (Index i = 0; i < n; ++i) {
    const double x = bar.positions[i].x();
    if (x > 0.0 && x < length) {
      unknown[i] = unknowns;
      unknowns += 3;
    }
  }
  // The far end moves by 1 along x.
  const auto end_moves = [&](Index i) { return bar.positions[i].x() < length ? 0.0 : 1.0; };
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns);
  for (Index s = 0; s < bar.springs.count(); ++s) {
    const Index ends[2] = {bar.springs.first[s], bar.springs.second[s]};
    const Vector3 along = (bar.positions[ends[1]] - bar.positions[ends[0]]).normalized();
    const Matrix3 block = bar.springs.stiffness[s] * along * along.transpose();
    for (int a = 0; a < 2; ++a) {
      if (unknown[ends[a]] == kNone) continue;
      for (int b = 0; b < 2; ++b) {
        const double sign = a == b ? 1.0 : -1.0;
        if (unknown[ends[b]] == kNone) {
          load.segment<3>(unknown[ends[a]]) -= sign * end_moves(ends[b]) * block.col(0);
          continue;
        }
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column)
            entries.emplace_back(unknown[ends[a]] + row, unknown[ends[b]] + column, sign * block(row, column));
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd moved = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(load);
  const auto displacement = [&](Index i) -> Vector3 {
    return unknown[i] == kNone ? Vector3(end_moves(i), 0, 0) : Vector3(moved.segment<3>(unknown[i]));
  };
  double force = 0.0;
  for (Index s = 0; s < bar.springs.count(); ++s) {
    const Index a = bar.springs.first[s];
    const Index b = bar.springs.second[s];
    const Vector3 along = (bar.positions[b] - bar.positions[a]).normalized();
    const double pull = bar.springs.stiffness[s] * along.dot(displacement(b) - displacement(a)) * along.x();
    force += pull * (end_moves(b) - end_moves(a));
  }
  return force * length / (kModulus * area);
}

/// A bar 2 x 0.5 x 0.5 with this number of cubes across.
double bar_stiffness(Index across, Cut cut, double moved_by) {
  const double side = 0.5 / across;
  TetrahedraMesh bar = make_box({4 * across, across, across}, side, cut);
  test::jitter(bar, moved_by * side, 7);
  return relative_stiffness(make_tetrahedra_body(bar, {modular(kModulus), std::nullopt, std::nullopt}), 2.0, 0.25);
}

TEST(TetrahedraBody, PulledBarHasTheStiffnessOfTheModulus) {
  for (const Index across : {1, 2, 4}) {
    for (const double moved_by : {0.0, 0.1, 0.15}) {
      for (const Cut cut : {Cut::five, Cut::six}) {
        EXPECT_NEAR(bar_stiffness(across, cut, moved_by), 1.0, 0.1)
            << across << " cubes across, cut " << static_cast<int>(cut) << ", vertices moved by " << moved_by;
      }
      // With one mirrored cube across, all space diagonals meet in every second layer, and the bar is a chain of pyramids.
      if (across > 1) {
        EXPECT_NEAR(bar_stiffness(across, Cut::mirrored, moved_by), 1.0, 0.1) << across << " cubes across, mirrored";
      }
    }
  }
}

TEST(TetrahedraBody, StiffnessDoesNotDependOnTheDirectionOfTheBar) {
  // Turning the mesh turns the springs: their stiffness is the same but for rounding.
  TetrahedraMesh mesh = make_box({3, 3, 3}, 0.1, Cut::six);
  test::jitter(mesh, 0.02, 5);
  const SpringMaterials materials{modular(kModulus), std::nullopt, std::nullopt};
  const Springs springs = make_tetrahedra_body(mesh, materials).springs;
  mesh.vertices = Eigen::AngleAxisd(1.0, Vector3(1, 2, 3).normalized()).toRotationMatrix() * mesh.vertices;
  const Springs turned = make_tetrahedra_body(mesh, materials).springs;
  for (Index s = 0; s < springs.count(); ++s) EXPECT_NEAR(turned.stiffness[s], springs.stiffness[s], 1e-9 * kModulus);
}

TEST(TetrahedraBody, StiffnessIsInProportionToTheSize) {
  TetrahedraMesh mesh = make_box({2, 2, 2}, 1.0, Cut::five);
  test::jitter(mesh, 0.1, 2);
  const SpringMaterials materials{modular(kModulus), std::nullopt, std::nullopt};
  const Springs springs = make_tetrahedra_body(mesh, materials).springs;
  mesh.vertices *= 4.0;  // a power of two: exact
  EXPECT_NEAR(make_tetrahedra_body(mesh, materials).springs.stiffness[5], 4.0 * springs.stiffness[5], 1e-9 * kModulus);
}

TEST(TetrahedraBody, HasOneSpringPerEdgeAndTheBoundaryAsItsSurface) {
  TetrahedraMesh mesh = make_box({3, 2, 2}, 0.5, Cut::five);
  test::jitter(mesh, 0.1, 4);
  const BodyShape body = make_tetrahedra_body(mesh, {stiff(7), std::nullopt, std::nullopt});
  std::set<Pair> edges;
  for (const auto& t : mesh.tetrahedra) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        if (t[a] < t[b]) edges.insert({t[a], t[b]});
      }
    }
  }
  EXPECT_EQ(pairs(body, SpringKind::structural), std::vector<Pair>(edges.begin(), edges.end()));
  EXPECT_EQ(body.springs.count(), static_cast<Index>(edges.size()));
  for (const double stiffness : body.springs.stiffness) EXPECT_EQ(stiffness, 7.0);
  ASSERT_EQ(body.positions.size(), 36U);
  for (Index i = 0; i < 36; ++i) EXPECT_EQ(body.positions[i], mesh.vertices.col(i));
  // Sums of at most 60 volumes, of numbers below 2 that are rounded by 2^-53.
  EXPECT_NEAR(signed_volume(mesh.vertices, body.surface.triangles), 1.5, 1e-13);
  EXPECT_NEAR(body.measure, 1.5, 1e-13);
  EXPECT_EQ(body.dimension, 3);
  EXPECT_EQ(body.cells.tetrahedra, mesh.tetrahedra);
}

TEST(TetrahedraBody, EachVertexHasAQuarterOfTheTetrahedraAroundIt) {
  const TetrahedraMesh one = make_box({1, 1, 1}, 1.0, Cut::five);
  const BodyShape body = make_tetrahedra_body(one, {});
  // The tetrahedron in the middle has a third of the cube, those in the corners a sixth each.
  for (Index i = 0; i < 8; ++i) {
    const bool of_middle = i == 0 || i == 3 || i == 5 || i == 6;
    EXPECT_NEAR(body.measures[i], of_middle ? (1.0 / 3.0 + 3.0 / 6.0) / 4.0 : 1.0 / 24.0, 1e-15);
  }
  EXPECT_EQ(body.springs.count(), 0);
}

TEST(TetrahedraBody, RejectsInvalidMeshesAndOtherSprings) {
  const TetrahedraMesh good = make_box({1, 1, 1}, 1.0, Cut::six);
  const auto keys = [](const TetrahedraMesh& mesh, const SpringMaterials& materials = {}) {
    return problem_keys([&] { return make_tetrahedra_body(mesh, materials); });
  };
  EXPECT_THAT(keys(good), ElementsAre());
  EXPECT_THAT(keys({}), ElementsAre("tetrahedra"));
  TetrahedraMesh bad = good;
  bad.tetrahedra[1][2] = 8;
  std::swap(bad.tetrahedra[3][0], bad.tetrahedra[3][1]);
  EXPECT_THAT(keys(bad), ElementsAre("tetrahedra[1]", "tetrahedra[3]"));
  bad = good;
  bad.vertices(1, 4) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(keys(bad), ::testing::Contains("vertices[4]"));
  EXPECT_THAT(keys(good, every_kind(stiff(1))), UnorderedElementsAre("springs.shear", "springs.bend"));
  EXPECT_THAT(keys(good, {stiff(-1), std::nullopt, std::nullopt}), ElementsAre("springs.structural.stiffness"));
}

}  // namespace
}  // namespace sprung
