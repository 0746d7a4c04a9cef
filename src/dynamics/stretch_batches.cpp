#include "dynamics/stretch_batches.h"

#include "dynamics/lane_count.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

namespace sprung {
namespace {

constexpr int kColours = 64;

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

using Colouring = std::array<std::vector<Index>, kColours>;

/// Gives springs the lowest colour that neither of their particles has, in their order; returns those for which none was left.
std::vector<Index> colour(const SpringNetwork& network, const std::vector<Index>& springs, Colouring& colours) {
  std::vector<std::uint64_t> used(network.particle_count(), 0);
  std::vector<Index> left;
  for (const Index s : springs) {
    std::uint64_t& at_first = used[network.springs.first[s]];
    std::uint64_t& at_second = used[network.springs.second[s]];
    const int lowest = std::countr_one(at_first | at_second);
    if (lowest == kColours) {
      left.push_back(s);
      continue;
    }
    at_first |= std::uint64_t{1} << lowest;
    at_second |= std::uint64_t{1} << lowest;
    colours[lowest].push_back(s);
  }
  return left;
}

}  // namespace

StretchBatches::StretchBatches(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  const auto append = [&](Index s) {
    const Index a = network.springs.first[s];
    const Index b = network.springs.second[s];
    first.push_back(a);
    second.push_back(b);
    rest_length.push_back(network.springs.rest_length[s]);
    first_share.push_back(network.inverse_masses[a] / (network.inverse_masses[a] + network.inverse_masses[b]));
  };
  for (std::vector<Index> waiting = limited_springs(network, kinds); !waiting.empty();) {
    Colouring colours;
    waiting = colour(network, waiting, colours);
    for (const std::vector<Index>& batch : colours) {
      if (batch.empty()) break;
      for (const Index s : batch) append(s);
      while (count() % kSpringLanes != 0) append(batch.back());
      begin.push_back(count());
    }
  }
}

}  // namespace sprung
