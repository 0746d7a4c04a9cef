#include "geometry/fixtures.h"
#include "geometry/import/mesh_import.h"
#include "geometry/mesh/topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sprung {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TriangleMesh flip(TriangleMesh mesh, std::initializer_list<Index> faces) {
  for (const Index face : faces) std::swap(mesh.triangles(1, face), mesh.triangles(2, face));
  return mesh;
}

// Each face has its own vertices.
TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup{Points(3, mesh.triangles.size()), Triangles(3, mesh.triangles.cols())};
  for (Index i = 0; i < mesh.triangles.size(); ++i) {
    soup.vertices.col(i) = mesh.vertices.col(mesh.triangles(i));
    soup.triangles(i) = i;
  }
  return soup;
}

TEST(CleanMesh, LeavesAGoodMeshAsItIs) {
  const TriangleMesh cube = test::make_cube();
  const auto [mesh, report] = clean_mesh(cube);
  EXPECT_EQ(mesh.vertices, cube.vertices);
  EXPECT_EQ(mesh.triangles, cube.triangles);
  EXPECT_EQ(report.vertices_read, 8);
  EXPECT_EQ(report.faces_read, 12);
  EXPECT_EQ(report.welded_vertices + report.unused_vertices + report.degenerate_faces + report.duplicate_faces, 0);
  EXPECT_EQ(report.flipped_faces + report.non_manifold_edges + report.border_edges, 0);
  EXPECT_EQ(report.components, 1);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.bounds.max(), Vector3(1, 1, 1));
  EXPECT_THAT(report.notes, IsEmpty());
}

// A face without area lies between an edge and the vertices on it, as in meshes from CAD programs.
TEST(CleanMesh, StaysClosedWhereAFlatFaceClosesATJunction) {
  TriangleMesh cube = test::make_cube();
  const Index a = cube.triangles(0, 0);
  const Index b = cube.triangles(1, 0);
  const Index c = cube.triangles(2, 0);
  const auto on_edge = [&](double part) -> Vector3 { return cube.vertices.col(a) * (1.0 - part) + cube.vertices.col(b) * part; };
  const Points corners = cube.vertices;
  cube.vertices.resize(3, 10);
  cube.vertices << corners, Vector3(on_edge(0.5)), Vector3(on_edge(0.25));
  const Index half = 8;
  const Index quarter = 9;
  const Triangles faces = cube.triangles.rightCols(11);
  cube.triangles.resize(3, 16);
  // The face a b c in three parts; flat faces between its edge a b and the neighbour.
  cube.triangles << faces,
      test::make_triangles({{a, quarter, c}, {quarter, half, c}, {half, b, c}, {b, half, a}, {half, quarter, a}});
  const auto [mesh, report] = clean_mesh(cube);
  EXPECT_EQ(report.degenerate_faces, 2);
  EXPECT_EQ(report.border_edges, 0);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(mesh.triangles.cols(), 16) << "the neighbour is in three parts too";
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0);
}

// Each end of an edge lies within the other's flat face: the splits must end.
TEST(CleanMesh, EndsWhenFlatFacesAreNeighbours) {
  const TriangleMesh line{test::make_points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}}),
                          test::make_triangles({{0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2}, {0, 3, 4}})};
  const auto [mesh, report] = clean_mesh(line);
  EXPECT_EQ(report.degenerate_faces, 4);
  EXPECT_EQ(report.non_manifold_edges, 0);
  EXPECT_GE(mesh.triangles.cols(), 1);
  double area = 0.0;
  for (const auto& face : mesh.triangles.colwise()) {
    area += 0.5 * area_normal(mesh.vertices.col(face[0]), mesh.vertices.col(face[1]), mesh.vertices.col(face[2])).norm();
  }
  EXPECT_DOUBLE_EQ(area, 1.5);
}

TEST(CleanMesh, WeldsASoupIntoASurface) {
  const auto [mesh, report] = clean_mesh(unwelded(test::make_cube()));
  EXPECT_EQ(mesh.vertices.cols(), 8);
  EXPECT_EQ(report.welded_vertices, 28);
  EXPECT_TRUE(report.closed);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0);
}

TEST(CleanMesh, TreatsMinusZeroAsZero) {
  const TriangleMesh mesh{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {1, -0.0, 0}, {0, -1, 0}}),
                          test::make_triangles({{0, 1, 2}, {4, 3, 5}})};
  EXPECT_EQ(clean_mesh(mesh).mesh.vertices.cols(), 4);
}

TEST(CleanMesh, KeepsVerticesOneRoundingApart) {
  const double next = std::nextafter(1.0, 2.0);
  const TriangleMesh mesh{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {next, 0, 0}, {0, 0, 1}}),
                          test::make_triangles({{0, 1, 2}, {0, 3, 4}})};
  EXPECT_EQ(clean_mesh(mesh).mesh.vertices.cols(), 5);
}

TEST(CleanMesh, DropsFacesWithoutAreaAtAnyScale) {
  for (const double scale : {1.0 / 128.0, 1.0, 128.0, 1e-30}) {
    TriangleMesh mesh{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, 1e-9, 0}}),
                      test::make_triangles({{0, 1, 2}, {0, 1, 1}, {0, 3, 1}, {0, 4, 1}})};
    mesh.vertices *= scale;
    const MeshReport report = clean_mesh(mesh).report;
    EXPECT_EQ(report.degenerate_faces, 2) << scale;  // the thin triangle of height 1e-9 still has a normal
    EXPECT_EQ(report.unused_vertices, 1) << scale;
  }
}

TEST(CleanMesh, DropsDuplicateFacesOfAnyWinding) {
  const TriangleMesh mesh{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                          test::make_triangles({{0, 1, 2}, {1, 2, 0}, {0, 2, 1}})};
  const auto [cleaned, report] = clean_mesh(mesh);
  EXPECT_EQ(report.duplicate_faces, 2);
  EXPECT_EQ(cleaned.triangles, test::make_triangles({{0, 1, 2}}));
}

TEST(CleanMesh, DropsAQuadThatIsGivenWithBothDiagonals) {
  TriangleMesh mesh = test::make_cube();
  mesh.triangles.conservativeResize(3, 14);
  mesh.triangles.rightCols(2) = test::make_triangles({{0, 2, 3}, {0, 3, 1}});  // the cube has 0 2 1 and 1 2 3
  const auto [cleaned, report] = clean_mesh(mesh);
  EXPECT_EQ(report.duplicate_faces, 2);
  EXPECT_TRUE(report.closed);
  EXPECT_DOUBLE_EQ(signed_volume(cleaned), 1.0);
}

TEST(CleanMesh, KeepsATetrahedron) {
  const TriangleMesh mesh{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
                          test::make_triangles({{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}})};
  EXPECT_EQ(clean_mesh(mesh).mesh.triangles, mesh.triangles);
}

TEST(CleanMesh, KeepsAWallBetweenTwoRooms) {
  // Two cubes with a common wall: the edges of the wall have three faces, but the wall exists once.
  TriangleMesh rooms = test::merge(test::make_cube(), test::make_cube(1.0, Vector3(1, 0, 0)));
  const auto [mesh, report] = clean_mesh(rooms);
  EXPECT_EQ(mesh.triangles.cols(), 22);
  EXPECT_EQ(report.non_manifold_edges, 4);
  EXPECT_FALSE(report.closed);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("4 edge(s)")));
}

TEST(CleanMesh, AccountsForEveryVertex) {
  TriangleMesh mesh = unwelded(test::make_cube());
  mesh.vertices.conservativeResize(3, 40);
  mesh.vertices.rightCols(4) = test::make_points({{9, 9, 9}, {9, 9, 9}, {8, 8, 8}, {0, 0, 0}});
  const auto [cleaned, report] = clean_mesh(mesh);
  EXPECT_EQ(report.welded_vertices, 30);  // 28, the second 9 9 9, the last 0 0 0
  EXPECT_EQ(report.unused_vertices, 2);
  EXPECT_EQ(report.welded_vertices + report.unused_vertices + cleaned.vertices.cols(), report.vertices_read);
}

TEST(CleanMesh, TurnsFacesOutward) {
  const auto [mesh, report] = clean_mesh(flip(test::make_cube(), {0, 3, 4, 11}));
  EXPECT_EQ(report.flipped_faces, 4);
  EXPECT_EQ(mesh.triangles, test::make_cube().triangles);
  EXPECT_EQ(clean_mesh(test::inside_out(test::make_cube())).report.flipped_faces, 12);
}

TEST(CleanMesh, RestoresAnySetOfFlippedFaces) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    TriangleMesh mesh = test::make_cube();
    for (Index face = 0; face < 12; ++face) {
      if (random() % 2 == 0) mesh = flip(mesh, {face});
    }
    EXPECT_DOUBLE_EQ(signed_volume(clean_mesh(mesh).mesh), 1.0);
  }
}

TEST(CleanMesh, TurnsEachComponentOutward) {
  const TriangleMesh two = test::merge(test::inside_out(test::make_cube()), test::make_cube(1.0, Vector3(3, 0, 0)));
  const auto [mesh, report] = clean_mesh(two);
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.flipped_faces, 12);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 2.0);
}

TEST(CleanMesh, KeepsTheWallOfACavity) {
  const TriangleMesh hollow = test::merge(test::make_cube(3.0), test::inside_out(test::make_cube(1.0, Vector3(1, 1, 1))));
  EXPECT_EQ(clean_mesh(hollow).report.flipped_faces, 0);
  const auto [mesh, report] = clean_mesh(test::inside_out(hollow));
  EXPECT_EQ(report.flipped_faces, 24);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 26.0);
}

TEST(CleanMesh, TurnsAnIslandInACavityOutward) {
  const TriangleMesh hollow = test::merge(test::make_cube(5.0), test::inside_out(test::make_cube(3.0, Vector3(1, 1, 1))));
  const TriangleMesh island = test::inside_out(test::make_cube(1.0, Vector3(2, 2, 2)));
  EXPECT_DOUBLE_EQ(signed_volume(clean_mesh(test::merge(island, hollow)).mesh), 125.0 - 27.0 + 1.0);
}

TEST(CleanMesh, OrientsAnOpenSheetLikeMostOfItsFaces) {
  const Triangles fan = test::make_triangles({{0, 1, 2}, {0, 2, 3}, {0, 4, 3}, {0, 4, 5}});
  const Points points = test::make_points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}});
  const auto [mesh, report] = clean_mesh({points, fan});
  EXPECT_EQ(report.flipped_faces, 1);
  EXPECT_EQ(mesh.triangles.col(2), Triangles::ColXpr::PlainObject(0, 3, 4));
  EXPECT_EQ(report.border_edges, 6);
  EXPECT_FALSE(report.closed);
}

TEST(CleanMesh, ReportsAMoebiusStrip) {
  // Five triangles in a band with a half turn.
  const TriangleMesh strip{test::make_points({{1, 0, 0}, {0.3, 0.9, 0.5}, {-0.8, 0.6, -0.4}, {-0.8, -0.6, 0.3}, {0.3, -0.9, -0.6}}),
                           test::make_triangles({{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}})};
  const MeshReport report = clean_mesh(strip).report;
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("one-sided")));
  EXPECT_FALSE(report.closed);
}

// Both sides of a square, cut along different diagonals: a tetrahedron without height. A height within single precision makes no
// inside either; a height of 1e-5 of the size does.
TEST(CleanMesh, TreatsAClosedSurfaceWithoutVolumeAsASheet) {
  for (const double height : {0.0, 1e-8, 1e-5}) {
    TriangleMesh mesh;
    mesh.vertices = (Points(3, 4) << -1, 1, 1, -1, height, 0, height, 0, -1, -1, 1, 1).finished();
    mesh.triangles = (Triangles(3, 4) << 3, 3, 0, 0, 2, 1, 1, 2, 1, 0, 2, 3).finished();
    const MeshReport report = clean_mesh(mesh).report;
    EXPECT_EQ(report.border_edges, 0);
    EXPECT_EQ(report.closed, height == 1e-5) << height;
    if (!report.closed) {
      EXPECT_THAT(report.notes, ElementsAre(HasSubstr("enclose no volume")));
    }
  }
}

TEST(CleanMesh, CountsNonManifoldEdges) {
  // Two cubes that touch along an edge: four faces share it, yet both cubes can be oriented outward.
  const auto [mesh, report] = clean_mesh(test::merge(test::inside_out(test::make_cube()), test::make_cube(1.0, Vector3(1, 1, 0))));
  EXPECT_EQ(report.non_manifold_edges, 1);
  EXPECT_EQ(report.components, 1);
  EXPECT_FALSE(report.closed);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 2.0);
}

std::string unit_note_of_cube(double side, double scale = 1.0, const OtherSizes& others = {}) {
  return unit_note(bounds(test::make_cube(side).vertices), scale, others).value_or("");
}

TEST(UnitNote, AsksAboutSizesBelowAMillimetreOrAbove100Metres) {
  EXPECT_EQ(unit_note_of_cube(632.0), "its largest extent is 632 m: if the file is in millimetres, place it with \"scale\": 0.001");
  EXPECT_THAT(unit_note_of_cube(0.0005), AllOf(HasSubstr("0.0005 m"), HasSubstr("a larger \"scale\"")));
  EXPECT_EQ(unit_note_of_cube(100.0), "");
  EXPECT_EQ(unit_note_of_cube(0.001), "");
  EXPECT_EQ(unit_note(Box3()), std::nullopt);
}

// A cup of 8 cm in millimetres, and a cloth.
TEST(UnitNote, AsksAboutSizesFarAboveThoseOfOtherThings) {
  EXPECT_THAT(unit_note_of_cube(80.0, 1.0, {0.4, 0.4}),
              AllOf(HasSubstr("80 m, 200 times that of anything else"), HasSubstr("0.001")));
  EXPECT_EQ(unit_note_of_cube(80.0, 1.0, {1.0, 1.0}), "");
  EXPECT_EQ(unit_note_of_cube(10.0, 1.0, {0.01, 0.01}), "") << "a room for a small thing";
}

TEST(UnitNote, AsksAboutSizesFarBelowThoseOfOtherThings) {
  EXPECT_THAT(unit_note_of_cube(0.005, 1.0, {1.0, 2.0}), AllOf(HasSubstr("at least 200 times as large"), HasSubstr("a larger")));
  EXPECT_EQ(unit_note_of_cube(0.01, 1.0, {1.0, 2.0}), "");
  EXPECT_EQ(unit_note_of_cube(0.005, 1.0, {0.005, 2.0}), "") << "one of several small things";
  EXPECT_EQ(unit_note_of_cube(0.5, 1.0, {80.0, 80.0}), "") << "the large one gets the question";
}

TEST(UnitNote, AppliesTheScaleOfThePlacement) {
  EXPECT_EQ(unit_note_of_cube(18000.0, 0.001), "");
  EXPECT_THAT(unit_note_of_cube(18.0, 1000.0), AllOf(HasSubstr("18000 m"), HasSubstr("\"scale\" 1000")));
}

TEST(CleanMesh, AnEmptyMeshStaysEmpty) {
  const auto [mesh, report] = clean_mesh({Points(3, 0), Triangles(3, 0)});
  EXPECT_EQ(mesh.triangles.cols(), 0);
  EXPECT_FALSE(report.closed);
}

}  // namespace
}  // namespace sprung
