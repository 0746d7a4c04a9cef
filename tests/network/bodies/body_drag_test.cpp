// The drag coefficients of shapes in air.
#include "base/error.h"
#include "network/bodies/body_shape.h"
#include "network/bodies/tetrahedra_body.h"
#include "network/network_builder.h"

#include <gmock/gmock.h>

#include <limits>

namespace sprung {
namespace {

/// Four faces with the corners of a tetrahedron, all of them or without the last one.
PolygonMesh tetrahedron(bool closed) {
  PolygonMesh mesh;
  mesh.vertices = (Points(3, 4) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1).finished();
  Triangles triangles = (Triangles(3, 4) << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3).finished();
  if (!closed) triangles.conservativeResize(3, 3);
  mesh.faces = to_polygons(triangles);
  mesh.lines = Edges(2, 0);
  return mesh;
}

constexpr double kHalfDensity = 0.6;  // of air of 1.2 kg/m^3

void expect_sheet(const BodyShape& shape) {
  const BodyDrag drag = drag_in_air(shape, 0.01);
  EXPECT_DOUBLE_EQ(drag.normal, kHalfDensity * 1.17);
  EXPECT_DOUBLE_EQ(drag.tangential, kHalfDensity * 2.0 * 0.005) << "two sides";
  EXPECT_EQ(drag.line_diameter, 0.0);
}

void expect_closed(const BodyShape& shape) {
  const BodyDrag drag = drag_in_air(shape, 0.01);
  EXPECT_DOUBLE_EQ(drag.normal, kHalfDensity * 0.5);
  EXPECT_DOUBLE_EQ(drag.tangential, kHalfDensity * 0.005) << "one side";
  EXPECT_EQ(drag.line_diameter, 0.0);
}

TEST(BodyDrag, OfOpenSurfacesIsThatOfAPlateAndOfClosedOnesThatOfASolid) {
  expect_sheet(make_cloth({}, {}));
  expect_sheet(make_mesh_body(tetrahedron(false), {}));
  expect_closed(make_mesh_body(tetrahedron(true), {}));
  expect_closed(make_solid({}, {}));
  TetrahedraMesh tetrahedra;
  tetrahedra.vertices = tetrahedron(true).vertices;
  tetrahedra.tetrahedra = {{0, 1, 2, 3}};
  expect_closed(make_tetrahedra_body(tetrahedra, {}));
}

TEST(BodyDrag, OfLinesHasTheirDiameter) {
  const BodyDrag drag =
      drag_in_air(make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = 5, .length = {}}, {}), 0.01);
  EXPECT_EQ(drag.line_diameter, 0.01);
  EXPECT_EQ(drag.normal, 0.0);
  EXPECT_EQ(drag.tangential, 0.0);
}

TEST(BodyDrag, OfAShapeIsZeroUnlessItIsGiven) { EXPECT_TRUE(make_cloth({}, {}).drag.is_zero()); }

TEST(BodyDrag, IsRefusedUnlessItIsFiniteAndNotNegative) {
  BodyShape shape = make_cloth({}, {});
  set_total_mass(shape, 1.0);
  shape.drag = {.normal = -1.0, .tangential = std::numeric_limits<double>::infinity(), .line_diameter = -0.01};
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  try {
    (void)builder.build();
    FAIL() << "it was accepted";
  } catch (const InputError& error) {
    std::vector<std::string> keys;
    for (const Problem& problem : error.problems()) keys.push_back(problem.key);
    EXPECT_THAT(keys, ::testing::ElementsAre("bodies.cloth.drag.normal", "bodies.cloth.drag.tangential",
                                             "bodies.cloth.drag.line_diameter"));
  }
}

}  // namespace
}  // namespace sprung
