#include "geometry/mesh/topology.h"

#include "geometry/fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

using testing::ElementsAre;

TEST(MeshEdges, TwoTrianglesShareTheirDiagonal) {
  const std::vector<MeshEdge> edges = mesh_edges(test::make_triangles({{0, 1, 2}, {2, 1, 3}}));
  ASSERT_EQ(edges.size(), 5U);
  const MeshEdge& diagonal = edges[2];
  EXPECT_THAT(diagonal.vertices, ElementsAre(1, 2));
  EXPECT_THAT(diagonal.triangles, ElementsAre(0, 1));
  EXPECT_THAT(diagonal.opposite, ElementsAre(0, 3));
  EXPECT_THAT(diagonal.forward, ElementsAre(true, false));
  EXPECT_EQ(diagonal.uses, 2);
  const MeshEdge& border = edges[0];
  EXPECT_THAT(border.vertices, ElementsAre(0, 1));
  EXPECT_THAT(border.triangles, ElementsAre(0, kNone));
  EXPECT_EQ(border.uses, 1);
}

TEST(MeshEdges, AreSortedAndUnique) {
  const std::vector<MeshEdge> edges = mesh_edges(test::make_cube().triangles);
  EXPECT_EQ(edges.size(), 18U);  // Euler: 8 - 18 + 12 = 2
  const auto not_before = [](const MeshEdge& a, const MeshEdge& b) { return a.vertices >= b.vertices; };
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end(), not_before), edges.end());
}

TEST(MeshEdges, CountAllUsesOfANonManifoldEdge) {
  const std::vector<MeshEdge> edges = mesh_edges(test::make_triangles({{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}));
  EXPECT_EQ(edges.front().uses, 3);
  EXPECT_THAT(edges.front().triangles, ElementsAre(0, 1));
}

TEST(UniqueEdges, GiveTheLowerVertexFirst) {
  Edges expected(2, 3);
  expected << 2, 2, 5, 5, 7, 7;
  EXPECT_EQ(unique_edges(test::make_triangles({{7, 2, 5}})), expected);
}

TEST(IsClosed, IsTrueForACube) { EXPECT_TRUE(is_closed(test::make_cube().triangles)); }

TEST(IsClosed, IsFalseForASurfaceWithAHole) { EXPECT_FALSE(is_closed(test::make_cube().triangles.leftCols(11))); }

TEST(IsClosed, IsFalseIfOneFaceIsReversed) {
  Triangles triangles = test::make_cube().triangles;
  std::swap(triangles(0, 4), triangles(1, 4));
  EXPECT_FALSE(is_closed(triangles));
}

TEST(IsClosed, IsFalseWithoutTriangles) { EXPECT_FALSE(is_closed(Triangles(3, 0))); }

TEST(TrianglesAroundVertices, ListsTheTrianglesThatUseEachVertex) {
  const VertexTriangles around = triangles_around_vertices(test::make_triangles({{0, 1, 2}, {4, 2, 1}, {2, 0, 4}}), 6);
  EXPECT_THAT(around.first, ElementsAre(0, 2, 4, 7, 7, 9, 9));
  EXPECT_THAT(around.triangle, ElementsAre(0, 2, 0, 1, 0, 1, 2, 1, 2));
}

TEST(ConnectedComponents, CountsSeparateSurfaces) {
  const TriangleMesh two = test::merge(test::make_cube(), test::make_cube(1.0, Vector3(3, 0, 0)));
  EXPECT_EQ(connected_components(two.triangles), 2);
}

TEST(ConnectedComponents, TrianglesWithACommonVertexAreConnected) {
  EXPECT_EQ(connected_components(test::make_triangles({{0, 1, 2}, {2, 3, 4}})), 1);
  EXPECT_EQ(connected_components(test::make_triangles({{0, 1, 2}, {5, 3, 4}})), 2);
  EXPECT_EQ(connected_components(Triangles(3, 0)), 0);
}

}  // namespace
}  // namespace sprung
