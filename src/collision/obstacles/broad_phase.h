// FCL's broad phase: which obstacles come near a box.
#pragma once

#include "collision/shapes/obstacle.h"
#include "collision/shapes/obstacle_shape.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <memory>
#include <vector>

namespace sprung {

/// Obstacles as FCL collision objects in a dynamic AABB tree. Half-spaces stay out of it, since no box bounds them (FCL's, of the
/// largest double, overflow in its tree's sums), and are compared with the box themselves.
class BroadPhase {
 public:
  /// Requires one shape per obstacle, made of its geometry, and keeps references to them. Obstacles are placed at `poses`.
  BroadPhase(const std::vector<Obstacle>& obstacles, const std::vector<std::unique_ptr<ObstacleShape>>& shapes,
             const std::vector<RigidTransform>& poses);

  /// Where the obstacles are from now on, as large as their shapes are now. Not thread-safe.
  void move(const std::vector<RigidTransform>& poses);

  /// Replaces `found` by the obstacles whose box meets `box`, ascending. May name more, never fewer. Thread-safe.
  void find_near(const Box3& box, std::vector<Index>& found) const;

 private:
  struct Object {
    std::unique_ptr<fcl::CollisionObject<double>> object;
    std::shared_ptr<fcl::CollisionGeometry<double>> geometry;
    const ObstacleShape* shape;
    RigidTransform turn;  ///< from FCL's frame of the shape, whose axis is z, to ours
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
