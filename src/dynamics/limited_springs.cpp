#include "dynamics/limited_springs.h"

#include <algorithm>

namespace sprung {

std::vector<Index> limited_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  const Springs& springs = network.springs;
  std::vector<Index> limited;
  for (Index s = 0; s < springs.count(); ++s) {
    const bool held = std::ranges::find(kinds, springs.kind[s]) != kinds.end();
    const bool movable = !network.is_pinned(springs.first[s]) || !network.is_pinned(springs.second[s]);
    if (held && movable && springs.rest_length[s] > 0.0) limited.push_back(s);
  }
  return limited;
}

}  // namespace sprung
