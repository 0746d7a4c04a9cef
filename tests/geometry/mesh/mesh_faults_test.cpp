#include "geometry/mesh/mesh_faults.h"

#include "geometry/mesh/weld.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

PolygonFaces faces_of(const std::vector<std::vector<Index>>& polygons) {
  PolygonFaces faces;
  for (const std::vector<Index>& corners : polygons) {
    faces.vertex.insert(faces.vertex.end(), corners.begin(), corners.end());
    faces.corner_begin.push_back(static_cast<Index>(faces.vertex.size()));
  }
  return faces;
}

std::vector<Index> numbers(Index count) {
  std::vector<Index> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

TEST(MeshFaults, FaceIsRepeatedOnEitherSideAndFromAnyCorner) {
  const PolygonFaces faces = faces_of({{0, 1, 2, 3}, {2, 3, 0, 1}, {3, 2, 1, 0}, {0, 1, 4}, {0, 1, 5}});
  EXPECT_EQ(count_repeated_faces(faces, numbers(6)), 2);
}

TEST(MeshFaults, FaceIsRepeatedByTrianglesThatCoverIt) {
  EXPECT_EQ(count_repeated_faces(faces_of({{0, 1, 2, 3}, {0, 1, 2}, {2, 3, 0}}), numbers(4)), 1);
  EXPECT_EQ(count_repeated_faces(faces_of({{1, 3, 2}, {1, 3, 0}, {0, 1, 2, 3}}), numbers(4)), 1) << "along the other diagonal";
  EXPECT_EQ(count_repeated_faces(faces_of({{0, 1, 2, 3, 4}, {2, 3, 4}, {2, 4, 0}, {0, 1, 2}}), numbers(5)), 1);
  EXPECT_EQ(count_repeated_faces(faces_of({{0, 1, 2, 3}, {0, 1, 2}, {0, 3, 4}}), numbers(5)), 0);
}

// The corners of the second triangle are other vertices at the same places.
TEST(MeshFaults, FaceIsRepeatedByVerticesAtTheSamePlace) {
  Points vertices(3, 6);
  vertices << 0, 1, 0, 0, 1, 0,  //
      0, 0, 1, 0, 0, 1,          //
      0, 0, 0, 0, 0, 0;
  const PolygonFaces faces = faces_of({{0, 1, 2}, {5, 4, 3}});
  EXPECT_EQ(count_repeated_faces(faces, coincident_groups(vertices, 0.0)), 1);
  EXPECT_EQ(count_repeated_faces(faces, numbers(6)), 0);
}

/// A square beside two half as high, whose common corner, vertex 8, lies at a height of `y` and at a distance of `gap` from the
/// side of the first: 3 - 2 of vertices 1 and 2.
Points squares(double gap, double y) {
  Points vertices(3, 9);
  const double x = 1.0 + gap;
  vertices << 0, 1, 1, 0, x, 2, 2, x, x,  //
      0, 0, 1, 1, 0, 0, 1, 1, y,          //
      0, 0, 0, 0, 0, 0, 0, 0, 0;
  return vertices;
}

const PolygonFaces kSquares = faces_of({{0, 1, 2, 3}, {4, 5, 8}, {8, 5, 6, 7}});

TEST(MeshFaults, VertexWithinTheDistanceOfABorderEdgeIsATVertex) {
  EXPECT_THAT(vertices_on_border_edges(squares(0.0, 0.5), kSquares, 0.0), ElementsAre(8));
  EXPECT_THAT(vertices_on_border_edges(squares(1e-3, 0.5), kSquares, 2e-3), ElementsAre(8));
  EXPECT_THAT(vertices_on_border_edges(squares(1e-3, 0.5), kSquares, 5e-4), IsEmpty());
}

// Near an end it is welded to that end instead.
TEST(MeshFaults, VertexNearTheEndOfAnEdgeIsNoTVertex) {
  EXPECT_THAT(vertices_on_border_edges(squares(0.0, 1e-3), kSquares, 2e-3), IsEmpty());
}

// Vertex 8 of the mesh in which both sides have it belongs to the edges there.
TEST(MeshFaults, SeamOfTwoFacesThatShareTheVertexHasNoTVertex) {
  const PolygonFaces faces = faces_of({{0, 1, 8, 2, 3}, {1, 5, 8}, {8, 5, 6, 2}});
  EXPECT_THAT(vertices_on_border_edges(squares(0.0, 0.5), faces, 1e-6), IsEmpty());
}

}  // namespace
}  // namespace sprung
