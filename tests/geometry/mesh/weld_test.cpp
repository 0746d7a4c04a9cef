// Which vertices a weld joins.
#include "geometry/mesh/weld.h"

#include "base/error.h"
#include "geometry/fixtures.h"

#include <gmock/gmock.h>

#include <limits>
#include <random>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two triangles side by side, with vertices of their own at the edge that they share.
PolygonMesh seam(double gap) {
  PolygonMesh mesh;
  mesh.vertices = test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, gap}, {1, 1, 0}, {0, 1, 0}});
  mesh.faces.corner_begin = {0, 3, 6};
  mesh.faces.vertex = {0, 1, 2, 3, 4, 5};
  return mesh;
}

std::string error_of(const PolygonMesh& mesh, double distance) {
  try {
    (void)weld(mesh, distance);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Weld, JoinsVerticesWithinTheDistanceInTheirOrder) {
  const WeldedMesh welded = weld(seam(0.25), 0.25);
  EXPECT_THAT(welded.vertex_of, ElementsAre(0, 1, 2, 1, 3, 2));
  EXPECT_EQ(welded.mesh.vertices, test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_THAT(welded.mesh.faces.vertex, ElementsAre(0, 1, 2, 1, 3, 2));
  EXPECT_THAT(weld(seam(0.25), 0.249).vertex_of, ElementsAre(0, 1, 2, 3, 4, 2));
  EXPECT_THAT(weld(seam(0.25), 0.0).vertex_of, ElementsAre(0, 1, 2, 3, 4, 2)) << "0 welds equal positions";
}

TEST(Weld, TakesLinesAlong) {
  PolygonMesh mesh = seam(0.0);
  mesh.lines.resize(2, 1);
  mesh.lines << 3, 4;
  EXPECT_EQ(weld(mesh, 0.0).mesh.lines.col(0), Eigen::Vector2i(1, 3));
}

TEST(Weld, RefusesADistanceThatIsNotLessThanEveryEdge) {
  EXPECT_THAT(error_of(seam(0.0), 1.0), HasSubstr("from vertex 2 to 0 is 1 m long"));
  PolygonMesh mesh = seam(0.0);
  mesh.lines.resize(2, 1);
  mesh.lines << 1, 3;
  EXPECT_THAT(error_of(mesh, 0.0), HasSubstr("repair the mesh"));
  EXPECT_THAT(error_of(seam(0.0), std::numeric_limits<double>::quiet_NaN()), HasSubstr("must be smaller"));
}

TEST(Weld, RefusesAChainThatClosesAFace) {
  PolygonMesh mesh = seam(0.0);
  // Between two corners of the first face, three quarters of an edge from each.
  const double x = 0.5;
  const double y = std::sqrt(0.75 * 0.75 - 0.25);
  mesh.vertices.conservativeResize(3, 7);
  mesh.vertices.col(6) = Vector3(x, 0.0, y);
  EXPECT_THAT(error_of(mesh, 0.76), HasSubstr("welds two corners of face 0"));
}

TEST(Weld, RefusesAChainThatClosesALine) {
  PolygonMesh mesh;
  mesh.vertices = (Points(3, 3) << 0.0, 0.6, 1.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished();
  mesh.faces = to_polygons(Triangles(3, 0));
  mesh.lines = (Edges(2, 1) << 0, 2).finished();
  EXPECT_THAT(error_of(mesh, 0.7), HasSubstr("welds both ends of line 0"));
}

TEST(Weld, GroupsAreThoseOfAllPairs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  // Planes and rows of equal coordinates as in a grid, and random places: chains of several vertices occur.
  for (const double distance : {0.0, 0.02, 0.1}) {
    Points points(3, 400);
    for (Index i = 0; i < points.cols(); ++i) {
      points.col(i) =
          i < 200 ? Vector3(i % 10, i / 10 % 10, 0.0) / 10.0 : Vector3(coordinate(random), coordinate(random), coordinate(random));
    }
    std::vector<Index> expected(400);
    for (Index i = 0; i < 400; ++i) expected[i] = i;
    for (bool changed = true; changed;) {
      changed = false;
      for (Index i = 0; i < 400; ++i) {
        for (Index j = 0; j < 400; ++j) {
          if ((points.col(i) - points.col(j)).norm() > distance || expected[j] >= expected[i]) continue;
          expected[i] = expected[j];
          changed = true;
        }
      }
    }
    EXPECT_EQ(coincident_groups(points, distance), expected) << distance;
  }
}

}  // namespace
}  // namespace sprung
