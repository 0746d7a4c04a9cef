// Particles that obstacles constrain, and the motion that a group of them has in common.
#pragma once

#include "collision/shapes/obstacle_shape.h"

#include <optional>
#include <span>

namespace sprung {

using AffineTransform = Eigen::Affine3d;

/// A particle that has no admissible position at its group's target, and the obstacle that it moves with instead.
struct BlockedVertex {
  Index particle = kNone;
  Index obstacle = kNone;                              ///< the moving obstacle that blocks the particle; kNone: the vertex stays
  RigidTransform motion = RigidTransform::Identity();  ///< of the obstacle's frame in this interval
  std::optional<MovedTriangle> surface{};              ///< nearest triangle of a deforming obstacle, in world coordinates

  [[nodiscard]] bool moves() const { return obstacle != kNone; }
};

/// The displacement [m] that a moving obstacle gives to a particle in this interval.
struct ParticleDisplacement {
  Index particle = kNone;
  Vector3 motion = Vector3::Zero();
};

/// The motion of a group with these vertices, as if the group were attached to the obstacle of the first moving one (of the first
/// one if none moves). For a rigid obstacle this is the motion of its frame. For a deforming one it is the affine map that fits
/// the vertices' triangles by least squares, close to the motion of the frame. Elements that do not cross before an affine map do
/// not cross after it. Requires at least one vertex.
[[nodiscard]] AffineTransform common_motion(std::span<const BlockedVertex> blocked);

}  // namespace sprung
