// The straight paths of particles in a step, in world coordinates and in an obstacle's frame.
#pragma once

#include "collision/core/sphere_set.h"
#include "collision/obstacles/obstacle_frame.h"

namespace sprung {

/// The straight paths of all particles in a step or a substep [m], 3 x n, and the obstacles in it. Refers to all of them.
struct StepPaths {
  const ObstacleFrame& obstacles;
  const Points& from;   ///< start positions, where nothing crosses
  const Points& to;     ///< target positions at the end of the obstacles' interval
  bool at_end = false;  ///< obstacles are at the end of their interval during the whole path
};

/// The paths of a patch's particles in an obstacle's frame, by slot. Refers to the positions, particles and poses it is made from.
class PatchPaths {
 public:
  PatchPaths(const SphereVertices& from, const SphereVertices& to) : from_(from), to_(to) {}

  [[nodiscard]] Vector3 from(Index slot) const { return position(from_, slot); }
  [[nodiscard]] Vector3 to(Index slot) const { return position(to_, slot); }
  [[nodiscard]] const SphereVertices& to() const { return to_; }

 private:
  [[nodiscard]] static Vector3 position(const SphereVertices& vertices, Index slot) {
    return vertices.into * vertices.positions.col(vertices.particles[static_cast<std::size_t>(slot)]);
  }

  SphereVertices from_;
  SphereVertices to_;
};

}  // namespace sprung
