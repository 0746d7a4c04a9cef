#include "scene/building/lattice_filling.h"

#include "base/error.h"
#include "collision/shapes/obstacle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace sprung {
namespace {

using ::testing::HasSubstr;

PolygonMesh surface_of(const ObstacleGeometry& geometry) {
  const TriangleMesh mesh = obstacle_mesh(geometry, 0.0);
  return {.vertices = mesh.vertices, .faces = to_polygons(mesh.triangles), .lines = Edges(2, 0)};
}

double volume(const LatticeShape& lattice) {
  double sum = 0.0;
  for (const LatticeShape::Cell& cell : lattice.cells) sum += cell.fraction;
  return sum * std::pow(lattice.cell_size, 3);
}

std::string refusal(const PolygonMesh& surface, double cell_size) {
  try {
    (void)fill_with_cells(surface, cell_size);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(LatticeFilling, EveryVertexIsInACell) {
  const LatticeShape lattice = fill_with_cells(surface_of(SphereGeometry{.radius = 1.0}), 0.13);
  EXPECT_NO_THROW((void)make_lattice_body(lattice, {}));
}

// Fractions of 27 points are off by about a tenth in each of the cells that the surface cuts, in either direction, and those below
// a quarter are raised: together a twentieth of a layer of cells, 4 pi r^2 h, which is 3 h / r = 0.3 of the volume.
TEST(LatticeFilling, CellsHaveTheVolumeOfTheSurface) {
  const double sphere = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_NEAR(volume(fill_with_cells(surface_of(SphereGeometry{.radius = 1.0}), 0.1)), sphere, 0.05 * sphere);
}

TEST(LatticeFilling, ABoxIsFilledByItsCells) {
  const LatticeShape lattice = fill_with_cells(surface_of(BoxGeometry{.size = {1.0, 0.5, 0.25}}), 0.25);
  EXPECT_EQ(lattice.cells.size(), 4U * 2U * 1U);
  for (const LatticeShape::Cell& cell : lattice.cells) EXPECT_EQ(cell.fraction, 1.0);
}

// 1.1 / (1.1 / 15) is more than 15 in doubles.
TEST(LatticeFilling, RoundingAddsNoCells) {
  const LatticeShape lattice = fill_with_cells(surface_of(BoxGeometry{.size = {1.1, 1.1, 1.1}}), 1.1 / 15);
  EXPECT_EQ(lattice.cells.size(), 15U * 15U * 15U);
}

TEST(LatticeFilling, RefusesAnOpenMeshWithItsBorder) {
  PolygonMesh open = surface_of(BoxGeometry{.size = {1.0, 1.0, 1.0}});
  open.faces = to_polygons(triangulate(open.faces).rightCols(11));
  EXPECT_THAT(refusal(open, 0.25), HasSubstr("an open mesh, with 3 border edges"));
}

TEST(LatticeFilling, RefusesAMeshThatHasNoInside) {
  PolygonMesh fin = surface_of(BoxGeometry{.size = {1.0, 1.0, 1.0}});
  Triangles triangles = triangulate(fin.faces);
  fin.vertices.conservativeResize(3, fin.vertices.cols() + 1);
  fin.vertices.rightCols(1) << 5.0, 5.0, 5.0;
  triangles.conservativeResize(3, triangles.cols() + 1);
  triangles.rightCols(1) << triangles(0, 0), triangles(1, 0), static_cast<Index>(fin.vertices.cols()) - 1;
  fin.faces = to_polygons(triangles);
  EXPECT_THAT(refusal(fin, 0.25), HasSubstr("a mesh with 1 edge of more than two faces"));
  EXPECT_THAT(refusal({fin.vertices, to_polygons(Triangles(3, 0)), Edges(2, 0)}, 0.25), HasSubstr("a mesh without faces"));
}

TEST(LatticeFilling, RefusesMoreCellsThanFit) {
  const PolygonMesh box = surface_of(BoxGeometry{.size = {1.0, 1.0, 1.0}});
  EXPECT_THAT(refusal(box, 1.0e-6), HasSubstr("at most 1024"));
  EXPECT_EQ(refusal(box, 0.5), "");
}

}  // namespace
}  // namespace sprung
