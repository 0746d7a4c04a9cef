// Single particles, each an element of its own, in the free space before an environment's obstacles.
#pragma once

#include "collision/obstacles/obstacle_intersections.h"
#include "collision/truncation/step_truncation.h"

#include <vector>

namespace sprung::test {

/// Particles of thickness 0; those of which `held` is not 0 are pinned.
inline CollisionSurface particle_surface(const std::vector<char>& held) {
  const auto count = static_cast<Index>(held.size());
  return make_collision_surface({}, Points::Zero(3, count), std::vector<Index>(held.size(), 0), Scalars::Zero(count), held, {0},
                                {0});
}

inline StepTruncation single_particles(Environment& environment, const std::vector<char>& held, double margin = 0.0) {
  return StepTruncation(environment, particle_surface(held), Points::Zero(3, static_cast<Index>(held.size())), margin);
}

inline StepTruncation single_particles(Environment& environment, Index count) {
  return single_particles(environment, std::vector<char>(static_cast<std::size_t>(count), 0));
}

/// What of the particles is in obstacles.
inline Intersections intersections(const Environment& environment, const Points& positions) {
  return find_intersections(environment.set(), particle_surface(std::vector<char>(static_cast<std::size_t>(positions.cols()), 0)),
                            positions);
}

}  // namespace sprung::test
