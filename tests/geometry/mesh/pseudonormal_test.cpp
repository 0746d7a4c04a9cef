#include "geometry/mesh/pseudonormal.h"

#include "geometry/fixtures.h"

#include <cmath>
#include <numbers>

namespace sprung {
namespace {

TEST(Pseudonormal, CubeCornersPointAlongTheirDiagonal) {
  const TriangleMesh cube = test::make_cube();
  const Pseudonormals normals = pseudonormals(cube);
  for (Index i = 0; i < 8; ++i) {
    // Three right angles meet at a corner, regardless of the number of triangles: the sum is pi/2 along each axis.
    const Vector3 outward = 2.0 * cube.vertices.col(i) - Vector3::Ones();
    const Vector3 expected = 0.5 * std::numbers::pi * outward;
    EXPECT_LT((normals.vertex.col(i) - expected).norm(), 1e-14) << i;
  }
}

TEST(Pseudonormal, EdgesSumTheNormalsOfTheirFaces) {
  const TriangleMesh cube = test::make_cube();
  const Pseudonormals normals = pseudonormals(cube);
  for (Index t = 0; t < 12; ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 along = cube.vertices.col(cube.triangles((k + 1) % 3, t)) - cube.vertices.col(cube.triangles(k, t));
      const Vector3 edge = normals.at(cube.triangles, t, static_cast<TriangleFeature>(3 + k));
      // The diagonal of a side lies between coplanar faces, an edge of the cube between perpendicular ones.
      EXPECT_NEAR(edge.norm(), along.norm() > 1.1 ? 2.0 : std::sqrt(2.0), 1e-15);
      EXPECT_EQ(edge.dot(along), 0.0);
    }
  }
}

TEST(Pseudonormal, VertexNormalsDoNotDependOnTheTriangulationOfASide) {
  // A pyramid whose base is cut along one diagonal or the other: the angles at the corners are the same in total.
  const auto pyramid = [](bool other) {
    TriangleMesh mesh;
    mesh.vertices = test::make_points({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0.5, 2, 0.5}});
    mesh.triangles = other ? test::make_triangles({{0, 1, 3}, {1, 2, 3}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}})
                           : test::make_triangles({{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}});
    return pseudonormals(mesh);
  };
  EXPECT_LT((pyramid(false).vertex - pyramid(true).vertex).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Pseudonormal, ASinglePseudonormalHasTheBitsOfTheWholeSet) {
  TriangleMesh mesh = test::merge(test::make_cube(), test::make_cube(0.3, Vector3(0.1, 0.7, 2.0)));
  for (Index i = 0; i < mesh.vertices.cols(); ++i)
    mesh.vertices.col(i) += 0.1 * Vector3(std::sin(i), std::cos(3 * i), std::sin(5 * i));
  const Pseudonormals all = pseudonormals(mesh);
  const VertexTriangles around = triangles_around_vertices(mesh.triangles, 16);
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 7; ++k) {
      const auto feature = static_cast<TriangleFeature>(k);
      EXPECT_EQ(pseudonormal(mesh, around, t, feature), all.at(mesh.triangles, t, feature)) << t << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace sprung
