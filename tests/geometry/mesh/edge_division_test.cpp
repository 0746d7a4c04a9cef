#include "geometry/mesh/edge_division.h"

#include "geometry/fixtures.h"
#include "geometry/mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace sprung {
namespace {

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) sum += 0.5 * area_normal(mesh, t).norm();
  return sum;
}

double longest_edge(const TriangleMesh& mesh) {
  const Edges edges = unique_edges(mesh.triangles);
  double longest = 0.0;
  for (const auto& ends : edges.colwise()) {
    longest = std::max(longest, (mesh.vertices.col(ends[0]) - mesh.vertices.col(ends[1])).norm());
  }
  return longest;
}

/// How far along the edge from `a` to `b` each vertex on it lies, in [0, 1], ascending.
std::vector<double> places_on(const TriangleMesh& mesh, const Vector3& a, const Vector3& b) {
  std::vector<double> places;
  for (const auto& vertex : mesh.vertices.colwise()) {
    const double along = (vertex - a).dot(b - a) / (b - a).squaredNorm();
    if (along >= 0.0 && along <= 1.0 && (a + along * (b - a) - vertex).norm() < 1.0e-12) places.push_back(along);
  }
  std::ranges::sort(places);
  return places;
}

// Rounding moves new vertices off the faces by some 1e-16 of coordinates of 1.
TEST(EdgeDivision, ASurfaceKeepsItsShapeAndStaysClosed) {
  std::mt19937 random(5);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same meshes in every run are intended
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    TriangleMesh mesh{Points(3, 4), test::make_triangles({{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})};
    for (double& value : mesh.vertices.reshaped()) value = coordinate(random);
    if (k % 3 == 0) mesh.vertices.row(1) *= 0.02;  // slivers
    const double longest = 0.05 + 0.3 * std::abs(coordinate(random));
    const TriangleMesh divided = divide_long_edges(mesh, longest);
    EXPECT_TRUE(is_closed(divided.triangles));
    EXPECT_EQ(divided.vertices.leftCols(4), mesh.vertices);
    EXPECT_NEAR(signed_volume(divided), signed_volume(mesh), 1.0e-12);
    EXPECT_NEAR(area(divided), area(mesh), 1.0e-12) << "nothing is folded";
    EXPECT_LT(longest_edge(divided), 1.5 * longest) << "rows and vertices in them are at most `longest` apart";
  }
}

TEST(EdgeDivision, AnEdgeHasTheFewestEqualPartsThatAreShortEnough) {
  const TriangleMesh divided = divide_long_edges(test::make_cube(), 0.3);
  const std::vector<double> of_side = places_on(divided, {0, 0, 0}, {1, 0, 0});
  ASSERT_EQ(of_side.size(), 4U + 1U);
  for (std::size_t k = 0; k < of_side.size(); ++k) EXPECT_NEAR(of_side[k], static_cast<double>(k) / 4.0, 1.0e-15);
  EXPECT_EQ(places_on(divided, {0, 1, 0}, {1, 0, 0}).size(), 5U + 1U) << "a diagonal of 1.41 / 0.3 = 4.7";
}

TEST(EdgeDivision, AMeshOfShortEdgesStaysAsItIs) {
  const TriangleMesh cube = test::make_cube();
  const TriangleMesh divided = divide_long_edges(cube, std::sqrt(2.0));
  EXPECT_EQ(divided.vertices, cube.vertices);
  EXPECT_EQ(divided.triangles, cube.triangles);
}

// A long strip of N cells needs two triangles for each of them; halving its edges again and again would make N^1.6.
TEST(EdgeDivision, ANeedleHasATriangleForEachPartOfItsSides) {
  const TriangleMesh needle{test::make_points({{0, 0, 0}, {100, 0, 0}, {100, 0.1, 0}}), test::make_triangles({{0, 1, 2}})};
  const TriangleMesh divided = divide_long_edges(needle, 1.0);
  EXPECT_LE(divided.triangles.cols(), 100 + 101);
}

// The same edge with other vertices, in the other direction.
TEST(EdgeDivision, BothSidesOfASeamHaveVerticesAtTheSamePlaces) {
  const Vector3 a(0.1, 0.2, 0.3);
  const Vector3 b(1.7, -0.4, 0.9);
  const TriangleMesh seam{test::make_points({a, b, {0, 2, 0}, b, a, {0, -2, 0}}), test::make_triangles({{0, 1, 2}, {3, 4, 5}})};
  const TriangleMesh divided = divide_long_edges(seam, 0.17);
  for (double at = 0.0; const double place : places_on(divided, a, b)) {
    EXPECT_TRUE(place == at || place - at > 0.05) << "same bits, or the next pair";
    at = place;
  }
  EXPECT_EQ(places_on(divided, a, b).size(), 2U * 12U) << "1.81 / 0.17 = 10.6, so 11 parts";
}

}  // namespace
}  // namespace sprung
