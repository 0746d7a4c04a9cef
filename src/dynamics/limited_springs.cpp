#include "dynamics/limited_springs.h"

#include <algorithm>

namespace sprung {

std::vector<Index> measurable_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  const Springs& springs = network.springs;
  std::vector<Index> measurable;
  for (Index s = 0; s < springs.count(); ++s) {
    if (springs.rest_length[s] > 0.0 && std::ranges::find(kinds, springs.kind[s]) != kinds.end()) measurable.push_back(s);
  }
  return measurable;
}

std::vector<Index> limited_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  std::vector<Index> limited = measurable_springs(network, kinds);
  std::erase_if(limited, [&](Index s) {
    return network.is_pinned(network.springs.first[s]) && network.is_pinned(network.springs.second[s]);
  });
  return limited;
}

}  // namespace sprung
