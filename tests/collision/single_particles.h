// Single particles as elements, and their truncation before obstacles.
#pragma once

#include "collision/obstacles/obstacle_intersections.h"
#include "collision/truncation/step_truncation.h"

#include <vector>

namespace sprung::test {

/// Particles of thickness 0.
inline CollisionSurface particle_surface(const ParticleMotions& motions) {
  const auto count = static_cast<Index>(motions.size());
  return make_collision_surface({}, Points::Zero(3, count), std::vector<Index>(motions.size(), 0), Scalars::Zero(count), motions,
                                {0}, {0});
}

inline StepTruncation single_particles(const ObstacleSet& obstacles, const ParticleMotions& motions, double margin = 0.0) {
  return StepTruncation(obstacles, particle_surface(motions), Points::Zero(3, static_cast<Index>(motions.size())), margin);
}

inline StepTruncation single_particles(const ObstacleSet& obstacles, Index count) {
  return single_particles(obstacles, ParticleMotions(static_cast<std::size_t>(count)));
}

/// The particles inside obstacles.
inline Intersections intersections(const ObstacleFrame& frame, const Points& positions) {
  return find_intersections(frame, particle_surface(ParticleMotions(static_cast<std::size_t>(positions.cols()))), positions);
}

}  // namespace sprung::test
