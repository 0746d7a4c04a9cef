#include "collision/mesh_bvh/mesh_bvh.h"

#include "collision/sample_meshes.h"

#include <gmock/gmock.h>

#include <set>

namespace sprung {
namespace {

using test::Random;

Box3 box_of(const TriangleMesh& mesh, Index triangle) {
  Box3 box;
  for (int k = 0; k < 3; ++k) box.extend(mesh.vertices.col(mesh.triangles(k, triangle)));
  return box;
}

/// Collects the triangles below a node and checks that its boxes contain them.
class TreeInspector {
 public:
  TreeInspector(const TriangleMesh& mesh, const MeshBvh& tree) : mesh_(mesh), tree_(tree) {}

  Box3 inspect_node(std::int32_t number) {
    const MeshBvh::Node& node = tree_.node(number);
    Box3 all;
    for (int lane = 0; lane < kFloatSimdWidth; ++lane) {
      if (!(node.min[0][lane] <= node.max[0][lane])) continue;  // no child
      const std::int32_t child = node.child[lane];
      if (child >= 0) {
        EXPECT_GT(child, number);
        EXPECT_TRUE(nodes_.insert(child).second);
      }
      const Box3 held = child >= 0 ? inspect_node(child) : inspect_block(~child);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(static_cast<double>(node.min[axis][lane]), held.min()[axis]);
        EXPECT_GE(static_cast<double>(node.max[axis][lane]), held.max()[axis]);
      }
      all.extend(held);
    }
    return all;
  }

  Box3 inspect_block(std::int32_t number) {
    const TrianglePacket& block = tree_.block(number);
    EXPECT_GE(block.count, 1);
    EXPECT_LE(block.count, kSimdWidth);
    Box3 all;
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      const Index triangle = block.triangle[lane];
      if (lane < block.count) {
        triangles_.push_back(triangle);
      } else {
        EXPECT_EQ(triangle, block.triangle[block.count - 1]);
      }
      for (int k = 0; k < 3; ++k) EXPECT_EQ(block.corners(lane)[k], mesh_.vertices.col(mesh_.triangles(k, triangle)));
      all.extend(box_of(mesh_, triangle));
    }
    return all;
  }

  [[nodiscard]] const std::vector<Index>& triangles() const { return triangles_; }

 private:
  const TriangleMesh& mesh_;
  const MeshBvh& tree_;
  std::set<std::int32_t> nodes_;
  std::vector<Index> triangles_;
};

std::vector<TriangleMesh> samples() {
  TriangleMesh one{Points(3, 3), Triangles(3, 1)};
  one.vertices << 0, 1, 0, 0, 0, 0, 0, 0, 1;
  one.triangles << 0, 1, 2;
  // Identical triangles, whose middles are equal.
  TriangleMesh pile{one.vertices, Triangles(3, 100)};
  for (Index t = 0; t < 100; ++t) pile.triangles.col(t) = one.triangles.col(0);
  TriangleMesh points{Points::Zero(3, 3), pile.triangles};
  return {one, pile, points, test::flat_sheet(1), test::flat_sheet(20), test::torus(1.0, 0.3, 40, 20), test::needles(24)};
}

TEST(MeshBvh, HoldsEachTriangleOnceInBoxesAroundIt) {
  for (const TriangleMesh& mesh : samples()) {
    const MeshBvh tree(mesh);
    TreeInspector inspector(mesh, tree);
    inspector.inspect_node(0);
    std::vector<Index> every(static_cast<std::size_t>(mesh.triangles.cols()));
    for (std::size_t t = 0; t < every.size(); ++t) every[t] = static_cast<Index>(t);
    EXPECT_THAT(inspector.triangles(), testing::UnorderedElementsAreArray(every));
  }
}

TEST(MeshBvh, NearestHasTheLeastOfAllTrianglesDistancesToTheLastBit) {
  Random random(8);
  for (const TriangleMesh& mesh : samples()) {
    const MeshBvh tree(mesh);
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = test::near_surface(mesh, random, std::pow(10.0, -random.between(0.0, 9.0)));
      double least = std::numeric_limits<double>::infinity();
      for (Index t = 0; t < mesh.triangles.cols(); ++t) {
        const auto corner = mesh.triangles.col(t);
        const ClosestPoint closest =
            closest_point_on_triangle(p, mesh.vertices.col(corner[0]), mesh.vertices.col(corner[1]), mesh.vertices.col(corner[2]));
        least = std::min(least, closest.squared_distance);
      }
      const auto found = tree.nearest(p, 10.0);
      ASSERT_TRUE(found);
      ASSERT_EQ(found->closest.squared_distance, least);
    }
  }
}

}  // namespace
}  // namespace sprung
