// Points that move with a deforming mesh.
#include "collision/shapes/surface_anchor.h"

#include "geometry/motion/motion.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

/// Two triangles that `pose` moves in one second, on straight lines.
MeshSequence moved_square(const RigidTransform& pose) {
  MeshSequence sequence{.triangles = (Triangles(3, 2) << 0, 0, 2, 3, 1, 2).finished(), .frames = {}, .frame_rate = 1.0};
  const Points corners = (Points(3, 4) << -1, 1, 1, -1, 0, 0, 0, 0, -1, -1, 1, 1).finished();
  sequence.frames = {corners, pose * corners};
  return sequence;
}

TEST(SurfaceAnchor, APointKeepsItsPlaceBesideATriangleThatMovesRigidly) {
  RigidTransform pose(Eigen::Translation3d(1.0, 2.0, 3.0));
  pose.linear() = rotation_from_degrees({30.0, 140.0, -70.0});
  const MeshSequence sequence = moved_square(pose);
  // Over a face, on it, beyond an edge, and beyond a corner.
  for (const Vector3& point :
       {Vector3(0.5, 0.25, -0.5), Vector3(0.5, 0.0, -0.5), Vector3(0.25, 0.5, -1.5), Vector3(2.0, 1.0, -3.0)}) {
    const Index triangle = nearest_triangles(sequence, 0.0, {point}).front();
    EXPECT_EQ(triangle, 0);
    const SurfaceAnchor anchor = anchored(sequence, triangle, 0.0, point);
    EXPECT_LE((anchored_position(sequence, anchor, 0.0) - point).norm(), 1e-15);
    EXPECT_LE((anchored_position(sequence, anchor, 1.0) - pose * point).norm(), 1e-14);
  }
}

TEST(SurfaceAnchor, APointMovesWithATriangleThatLosesItsArea) {
  MeshSequence sequence = moved_square(RigidTransform::Identity());
  sequence.frames[1] = (Points(3, 4) << 1, 1, 1, 1, 5, 5, 5, 5, 0, 0, 0, 0).finished();
  const SurfaceAnchor anchor = anchored(sequence, 0, 0.0, {0.5, 0.25, -0.5});
  const Vector3 end = anchored_position(sequence, anchor, 1.0);
  EXPECT_TRUE(end.allFinite());
  EXPECT_NEAR((end - Vector3(1.0, 5.0, 0.0)).norm(), 0.25, 1e-14);
}

}  // namespace
}  // namespace sprung
