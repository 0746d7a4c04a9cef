// Broad phase: finds the obstacles near a box.
#pragma once

#include "collision/shapes/obstacle.h"
#include "collision/shapes/obstacle_shape.h"

#include <memory>
#include <variant>
#include <vector>

namespace sprung {

/// What bounds an obstacle in world coordinates [m]: a box, or the plane of a half-space, whose box would be infinite.
struct ObstacleBound {
  Index obstacle = kNone;
  std::variant<Box3, HalfSpaceGeometry> bound;
};

/// FCL's dynamic AABB tree over the obstacles that never change. The bounds of the others, and of half-spaces (FCL's largest double
/// overflows in the sums of the tree), are tested one by one. Const after construction, thread-safe.
class BroadPhase {
 public:
  /// Requires one shape per obstacle, built from its geometry, and the poses of the obstacles that never change.
  BroadPhase(const std::vector<Obstacle>& obstacles, const std::vector<std::shared_ptr<const ObstacleShape>>& shapes,
             const std::vector<RigidTransform>& poses);
  ~BroadPhase();

  /// The bound of obstacle k at a pose. Requires an obstacle that changes, and its shape in the interval that ends there.
  [[nodiscard]] ObstacleBound bound_at(Index k, const RigidTransform& pose, const ObstacleShape& shape) const;

  /// Replaces `found` by the obstacles whose bound intersects `box`, in ascending order; `changing` are the bounds of those that
  /// change. The result may contain more, never fewer.
  void find_near(const Box3& box, const std::vector<ObstacleBound>& changing, std::vector<Index>& found) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
