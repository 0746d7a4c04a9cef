#include "dynamics/tethers/limited_springs.h"

#include <algorithm>

namespace sprung {

namespace {

bool is_measurable(const SpringNetwork& network, const std::vector<SpringKind>& kinds, Index spring) {
  const Springs& springs = network.springs;
  const SpringLaw law = springs.law(spring);
  return springs.rest_length[spring] > 0.0 && !law.yields() && !law.breaks() &&
         std::ranges::find(kinds, springs.kind[spring]) != kinds.end() && network.body_of(springs.first[spring]).stretch_limited;
}

}  // namespace

bool is_limited(const SpringNetwork& network, const std::vector<SpringKind>& kinds, Index spring) {
  const Springs& springs = network.springs;
  const bool between_pins = network.is_fixed(springs.first[spring]) && network.is_fixed(springs.second[spring]);
  return !between_pins && is_measurable(network, kinds, spring);
}

std::vector<Index> measurable_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  std::vector<Index> measurable;
  for (Index s = 0; s < network.springs.count(); ++s) {
    if (is_measurable(network, kinds, s)) measurable.push_back(s);
  }
  return measurable;
}

std::vector<Index> limited_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  std::vector<Index> limited;
  for (Index s = 0; s < network.springs.count(); ++s) {
    if (is_limited(network, kinds, s)) limited.push_back(s);
  }
  return limited;
}

}  // namespace sprung
