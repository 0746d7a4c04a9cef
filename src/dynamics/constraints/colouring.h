// Groups of particles in an order in which many can be projected at the same time.
#pragma once

#include "base/types.h"

#include <functional>
#include <span>
#include <vector>

namespace sprung {

/// Numbers of groups. Those of one colour, [colour_begin[c], colour_begin[c + 1]), share no particle.
struct Colouring {
  std::vector<std::size_t> order;
  std::vector<std::size_t> colour_begin{0};
};

/// Gives each of `groups` groups the lowest colour that none of its particles has.
[[nodiscard]] Colouring colour_groups(std::size_t groups, Index particles,
                                      const std::function<std::span<const Index>(std::size_t)>& particles_of);

}  // namespace sprung
