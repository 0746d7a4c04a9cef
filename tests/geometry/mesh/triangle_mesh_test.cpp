#include "geometry/mesh/triangle_mesh.h"

#include "geometry/fixtures.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

TEST(Bounds, ContainsExactlyThePoints) {
  const Box3 box = bounds(test::make_points({{1, 5, -2}, {3, -4, 0}, {2, 0, 7}}));
  EXPECT_EQ(box.min(), Vector3(1, -4, -2));
  EXPECT_EQ(box.max(), Vector3(3, 5, 7));
}

TEST(Bounds, AreEmptyWithoutPoints) { EXPECT_TRUE(bounds(Points(3, 0)).isEmpty()); }

TEST(AreaNormal, IsTwiceTheAreaAlongTheNormal) {
  const TriangleMesh mesh{test::make_points({{0, 0, 0}, {3, 0, 0}, {0, 2, 0}}), test::make_triangles({{0, 1, 2}})};
  EXPECT_EQ(area_normal(mesh, 0), Vector3(0, 0, 6));
}

TEST(SignedVolume, OfACubeIsItsEdgeCubed) {
  EXPECT_DOUBLE_EQ(signed_volume(test::make_cube()), 1.0);
  EXPECT_DOUBLE_EQ(signed_volume(test::make_cube(0.5)), 0.125);
}

TEST(SignedVolume, IsNegativeInsideOut) { EXPECT_DOUBLE_EQ(signed_volume(test::inside_out(test::make_cube())), -1.0); }

TEST(SignedVolume, KeepsItsDigitsFarFromTheOrigin) {
  // The corners are whole numbers, so every difference is exact.
  EXPECT_EQ(signed_volume(test::make_cube(1.0, Vector3(1e9, -1e9, 1e9))), 1.0);
}

TEST(SignedVolume, IsZeroWithoutTriangles) { EXPECT_EQ(signed_volume({Points(3, 0), Triangles(3, 0)}), 0.0); }

}  // namespace
}  // namespace sprung
