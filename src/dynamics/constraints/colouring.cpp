#include "dynamics/constraints/colouring.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

namespace sprung {

// A group that finds none of 64 colours is a colour of its own.
Colouring colour_groups(std::size_t groups, Index particles,
                        const std::function<std::span<const Index>(std::size_t)>& particles_of) {
  constexpr std::size_t kColours = 64;
  std::vector<std::uint64_t> taken(particles, 0);
  std::vector<std::size_t> colours(groups);
  for (std::size_t g = 0; g < groups; ++g) {
    std::uint64_t used = 0;
    for (const Index particle : particles_of(g)) used |= taken[particle];
    colours[g] = static_cast<std::size_t>(std::countr_one(used));
    if (colours[g] == kColours) continue;
    for (const Index particle : particles_of(g)) taken[particle] |= std::uint64_t{1} << colours[g];
  }
  Colouring colouring;
  colouring.order.resize(groups);
  std::iota(colouring.order.begin(), colouring.order.end(), std::size_t{0});
  std::ranges::stable_sort(colouring.order, {}, [&](std::size_t g) { return colours[g]; });
  for (std::size_t k = 1; k <= groups; ++k) {
    const std::size_t colour = colours[colouring.order[k - 1]];
    if (k == groups || colour == kColours || colours[colouring.order[k]] != colour) colouring.colour_begin.push_back(k);
  }
  return colouring;
}

}  // namespace sprung
