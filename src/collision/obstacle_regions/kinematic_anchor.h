// Particles that obstacles hold fast, and the motions with which these take whole groups along.
#pragma once

#include "collision/shapes/moved_triangle.h"

#include <optional>
#include <span>

namespace sprung {

using AffineTransform = Eigen::Affine3d;

/// A particle that obstacles leave no place where its group would take it.
struct KinematicAnchor {
  Index particle = kNone;
  Index obstacle = kNone;                              ///< which moves and is in its way; kNone: it stays
  RigidTransform motion = RigidTransform::Identity();  ///< of the obstacle, but for its deforming
  std::optional<MovedTriangle> surface{};              ///< that is nearest to the particle, where the obstacle deforms

  [[nodiscard]] bool moves() const { return obstacle != kNone; }
};

/// A particle that leans on an obstacle, and how far that carries it in this step [m].
struct ParticleDisplacement {
  Index particle = kNone;
  Vector3 motion = Vector3::Zero();
};

/// A motion for all that hangs together with these anchors, as if it were a part of the obstacle that the first is at (the first
/// that moves, if one does): the obstacle's own if that is rigid; else the affine map, near its rigid part, that takes the surface
/// at its anchors along with the least squares of what it misses. What does not cross before an affine map does not cross after
/// it. Requires an anchor.
[[nodiscard]] AffineTransform common_motion(std::span<const KinematicAnchor> anchors);

}  // namespace sprung
