// Single particles, each an element of its own, in the free space before an environment's obstacles.
#pragma once

#include "collision/free_space.h"

#include <vector>

namespace sprung::test {

/// Particles of thickness 0; those of which `held` is not 0 are pinned.
inline FreeSpace single_particles(Environment& environment, const std::vector<char>& held, double margin = 0.0) {
  const auto count = static_cast<Index>(held.size());
  return FreeSpace(
      environment,
      make_collision_surface({}, Points::Zero(3, count), std::vector<Index>(held.size(), 0), Scalars::Zero(count), held, {0}, {0}),
      margin);
}

inline FreeSpace single_particles(Environment& environment, Index count) {
  return single_particles(environment, std::vector<char>(static_cast<std::size_t>(count), 0));
}

}  // namespace sprung::test
