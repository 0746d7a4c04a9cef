#include "dynamics/stretch_batches.h"

#include "dynamics/lane_count.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
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

/// Springs [begin, begin + count) of the network: one, or a run that fills the kernel's lanes.
struct Piece {
  Index begin;
  Index count;
};

/// How many springs from `limited[i]` on join consecutive particles, each of them once.
Index run_length(const Springs& springs, const std::vector<Index>& limited, std::size_t i) {
  const Index s = limited[i];
  const Index most = std::min(springs.second[s] - springs.first[s], StretchBatches::kPartSprings);
  Index count = 1;
  while (count < most && i + count < limited.size() && limited[i + count] == s + count &&
         springs.first[s + count] == springs.first[s] + count && springs.second[s + count] == springs.second[s] + count) {
    ++count;
  }
  return count;
}

std::vector<Piece> pieces(const Springs& springs, const std::vector<Index>& limited) {
  std::vector<Piece> found;
  for (std::size_t i = 0; i < limited.size();) {
    const Index whole = run_length(springs, limited, i) / kSpringLanes * kSpringLanes;
    found.push_back({limited[i], std::max(whole, Index{1})});
    i += static_cast<std::size_t>(found.back().count);
  }
  return found;
}

struct Colour {
  std::vector<Piece> runs;
  std::vector<Piece> singles;
};
using Colouring = std::array<Colour, kColours>;

/// Gives pieces the lowest colour that none of their particles has, in their order; returns those for which none was left.
std::vector<Piece> colour(const SpringNetwork& network, const std::vector<Piece>& pieces, Colouring& colours) {
  std::vector<std::uint64_t> used(network.particle_count(), 0);
  std::vector<Piece> left;
  for (const Piece& piece : pieces) {
    std::uint64_t taken = 0;
    for (Index s = piece.begin; s < piece.begin + piece.count; ++s) {
      taken |= used[network.springs.first[s]] | used[network.springs.second[s]];
    }
    const int lowest = std::countr_one(taken);
    if (lowest == kColours) {
      left.push_back(piece);
      continue;
    }
    for (Index s = piece.begin; s < piece.begin + piece.count; ++s) {
      used[network.springs.first[s]] |= std::uint64_t{1} << lowest;
      used[network.springs.second[s]] |= std::uint64_t{1} << lowest;
    }
    (piece.count > 1 ? colours[lowest].runs : colours[lowest].singles).push_back(piece);
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
    per_length.push_back(1.0 / network.springs.rest_length[s]);
    first_share.push_back(network.inverse_masses[a] / (network.inverse_masses[a] + network.inverse_masses[b]));
  };
  const auto add_part = [&](Index from, bool run) {
    const auto same = [&](const std::vector<double>& values) {
      return std::all_of(values.begin() + from, values.end(), [&](double value) { return value == values[from]; });
    };
    parts.push_back({from, count(), run, same(rest_length) && same(first_share)});
  };
  const auto append_run = [&](const Piece& run) {
    const Index from = count();
    for (Index s = run.begin; s < run.begin + run.count; ++s) append(s);
    add_part(from, true);
  };
  const auto append_singles = [&](std::span<const Piece> singles) {
    const Index from = count();
    for (const Piece& single : singles) append(single.begin);
    while (count() % kSpringLanes != 0) append(singles.back().begin);
    add_part(from, false);
  };
  for (std::vector<Piece> waiting = pieces(network.springs, limited_springs(network, kinds)); !waiting.empty();) {
    Colouring colours;
    waiting = colour(network, waiting, colours);
    for (const auto& [runs, singles] : colours) {
      if (runs.empty() && singles.empty()) break;
      for (const Piece& run : runs) append_run(run);
      for (std::size_t i = 0; i < singles.size(); i += kPartSprings) {
        append_singles(std::span(singles).subspan(i, std::min<std::size_t>(kPartSprings, singles.size() - i)));
      }
      begin.push_back(static_cast<Index>(parts.size()));
    }
  }
}

}  // namespace sprung
