#include "collision/mesh_bvh/mesh_bvh.h"

#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle_shape.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace sprung {
namespace {

using test::Random;

/// Both meshes as components of one mesh.
TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both{Points(3, a.vertices.cols() + b.vertices.cols()), Triangles(3, a.triangles.cols() + b.triangles.cols())};
  both.vertices << a.vertices, b.vertices;
  both.triangles << a.triangles, b.triangles.array() + static_cast<Index>(a.vertices.cols());
  return both;
}

TriangleMesh moved(TriangleMesh mesh, const Vector3& by) {
  mesh.vertices.colwise() += by;
  return mesh;
}

/// A closed box with a square of two triangles a side, outward oriented.
TriangleMesh box_mesh(const Vector3& low, const Vector3& high) { return obstacle_mesh(BoxGeometry{high - low}, 0.0); }

TEST(MeshInside, WindingNumberIsThatOfSolidAngles) {
  const TriangleMesh tori = together(test::torus(1.0, 0.3, 24, 12), moved(test::torus(0.9, 0.4, 20, 10), Vector3(0.5, 0.1, 0.2)));
  for (const TriangleMesh& mesh : {test::torus(1.0, 0.3, 40, 20), test::needles(24), tori}) {
    const MeshBvh tree(mesh);
    const Box3 box = bounds(mesh.vertices);
    Random random(1);
    std::array<int, 3> seen{};
    for (int i = 0; i < 2000; ++i) {
      const Vector3 p = i % 4 == 0 ? random.in_box(box) : test::near_surface(mesh, random, 0.05 * random.between(0.001, 1));
      const int winding = winding_number(tree, p);
      // Solid angles are summed in doubles, far from a half.
      ASSERT_NEAR(winding, test::winding_number(mesh, p), 1e-6) << "point " << i;
      ++seen.at(static_cast<std::size_t>(winding));
    }
    EXPECT_GT(seen[0], 100);
    EXPECT_GT(seen[1], 100);
  }
}

TEST(MeshInside, RaysThroughEdgesAndVerticesCountOnce) {
  // Two boxes with integer corners, queried at quarters of a grid: most rays hit edges, many hit vertices, some run within faces.
  const Box3 first(Vector3(0, 0, 0), Vector3(4, 2, 4));
  const Box3 second(Vector3(2, 1, -1), Vector3(6, 3, 3));
  const auto mesh_of = [](const Box3& box) { return moved(box_mesh(box.min(), box.max()), box.center()); };
  const MeshBvh tree(together(mesh_of(first), mesh_of(second)));
  const auto strictly_within = [](const Box3& box, const Vector3& p) {
    return (p.array() > box.min().array()).all() && (p.array() < box.max().array()).all();
  };
  int asked = 0;
  for (double x = -1.0; x <= 7.0; x += 0.5) {
    for (double y = -1.0; y <= 4.0; y += 0.25) {
      for (double z = -2.0; z <= 5.0; z += 0.25) {
        const Vector3 p(x, y, z);
        const bool on_surface =
            (first.contains(p) && !strictly_within(first, p)) || (second.contains(p) && !strictly_within(second, p));
        if (on_surface) continue;
        ++asked;
        const int expected = (strictly_within(first, p) ? 1 : 0) + (strictly_within(second, p) ? 1 : 0);
        ASSERT_EQ(winding_number(tree, p), expected) << p.transpose();
      }
    }
  }
  EXPECT_GT(asked, 7000);
}

TEST(MeshInside, OverlapOfComponentsIsInside) {
  const auto box = [](const Vector3& centre) { return moved(box_mesh(Vector3::Constant(-1), Vector3::Constant(1)), centre); };
  const TriangleMesh mesh = together(box(Vector3::Zero()), box(Vector3(1.0, 0.1, 0.2)));
  const auto shape = make_shape(MeshGeometry{std::make_shared<TriangleMesh>(mesh), true});
  // Just outside the first box but inside the second: the nearest face is inside the second box.
  EXPECT_TRUE(shape->contains(Vector3(1.01, 0.0, 0.0)));
  EXPECT_TRUE(shape->contains(Vector3(0.99, 0.0, 0.0)));
  EXPECT_FALSE(shape->contains(Vector3(2.01, 0.0, 0.0)));
}

TEST(MeshInside, BoxFindsTheTrianglesThatItMeets) {
  const TriangleMesh mesh = test::torus(1.0, 0.3, 40, 20);
  const MeshBvh tree(mesh);
  Random random(2);
  std::vector<Index> found;
  for (int i = 0; i < 300; ++i) {
    const Vector3 p = random.in_box(bounds(mesh.vertices));
    const Box3 box(p, p + random.between(0.0, 0.3) * Vector3::Ones());
    find_in_box(tree, box, found);
    Index expected = 0;
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      Box3 around;
      for (int k = 0; k < 3; ++k) around.extend(mesh.vertices.col(mesh.triangles(k, t)));
      if (!around.intersects(box)) continue;
      ++expected;
      ASSERT_THAT(found, testing::Contains(t));
    }
    // Boxes are rounded outward in single precision, which rarely adds another one.
    ASSERT_LE(static_cast<Index>(found.size()), expected + 2);
  }
}

}  // namespace
}  // namespace sprung
