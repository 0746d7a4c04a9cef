// Broad phase (FCL): finds the obstacles near a box.
#pragma once

#include "collision/shapes/obstacle.h"
#include "collision/shapes/obstacle_shape.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <memory>
#include <vector>

namespace sprung {

/// A dynamic AABB tree (FCL) over the obstacles. Half-spaces are not in the tree, because their boxes are infinite (FCL's largest
/// double overflows in the sums of the tree). They are tested one by one.
class BroadPhase {
 public:
  /// Requires one shape per obstacle, built from its geometry. Keeps references to both. `poses` are the initial poses.
  BroadPhase(const std::vector<Obstacle>& obstacles, const std::vector<std::unique_ptr<ObstacleShape>>& shapes,
             const std::vector<RigidTransform>& poses);

  /// Updates the poses of the obstacles and the boxes of deforming shapes. Not thread-safe.
  void move(const std::vector<RigidTransform>& poses);

  /// Replaces `found` by the obstacles whose box intersects `box`, in ascending order. The result may contain more, never fewer.
  /// Thread-safe.
  void find_near(const Box3& box, std::vector<Index>& found) const;

 private:
  struct Object {
    std::unique_ptr<fcl::CollisionObject<double>> object;
    std::shared_ptr<fcl::CollisionGeometry<double>> geometry;
    const ObstacleShape* shape;
    RigidTransform rotation;  ///< from FCL's frame of the shape, with axis z, to the obstacle's
    Index obstacle;
  };
  struct Plane {
    HalfSpaceGeometry local;
    HalfSpaceGeometry world;
    Index obstacle;
  };

  std::vector<Object> objects_;
  std::vector<Plane> planes_;
  fcl::DynamicAABBTreeCollisionManager<double> manager_;
};

}  // namespace sprung
