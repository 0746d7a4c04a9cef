// Single particles as elements, and their truncation before obstacles.
#pragma once

#include "collision/obstacles/obstacle_intersections.h"
#include "collision/truncation/step_truncation.h"

#include <vector>

namespace sprung::test {

/// Particles of thickness 0; `pinned` is not 0 for pinned ones.
inline CollisionSurface particle_surface(const std::vector<char>& pinned) {
  const auto count = static_cast<Index>(pinned.size());
  return make_collision_surface({}, Points::Zero(3, count), std::vector<Index>(pinned.size(), 0), Scalars::Zero(count), pinned, {0},
                                {0});
}

inline StepTruncation single_particles(const ObstacleSet& obstacles, const std::vector<char>& pinned, double margin = 0.0) {
  return StepTruncation(obstacles, particle_surface(pinned), Points::Zero(3, static_cast<Index>(pinned.size())), margin);
}

inline StepTruncation single_particles(const ObstacleSet& obstacles, Index count) {
  return single_particles(obstacles, std::vector<char>(static_cast<std::size_t>(count), 0));
}

/// The particles inside obstacles.
inline Intersections intersections(const ObstacleFrame& frame, const Points& positions) {
  return find_intersections(frame, particle_surface(std::vector<char>(static_cast<std::size_t>(positions.cols()), 0)), positions);
}

}  // namespace sprung::test
