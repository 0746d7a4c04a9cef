#include "dynamics/stretch_limit/spring_batches.h"

#include "base/machine/simd.h"
#include "dynamics/stretch_limit/batch_order.h"
#include "dynamics/tethers/limited_springs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>

namespace sprung {
namespace {

constexpr int kColours = 64;

// A network is narrow if springs join particles whose numbers differ by at most one part in this many of all: rows of a cloth.
constexpr Index kNarrow = 32;

// In a narrow network a batch holds springs of a few rows only: longer batches are cheaper, shorter ones can run as soon as their
// rows are ready.
constexpr Index kSpan = 4;

/// Springs [begin, begin + count) of the network: a single one, or a run of at least kSimdWidth.
struct Piece {
  Index begin;
  Index count;
};

/// Number of springs from `limited[i]` on that join consecutive particles, each particle once.
Index run_length(const Springs& springs, const std::vector<Index>& limited, std::size_t i) {
  const Index s = limited[i];
  const Index most = std::min(springs.second[s] - springs.first[s], SpringBatches::kBatchSprings);
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
    const Index length = run_length(springs, limited, i);
    const Index whole = length % kSimdWidth == 1 ? length - 1 : length;
    found.push_back({limited[i], length < kSimdWidth ? 1 : whole});
    i += static_cast<std::size_t>(found.back().count);
  }
  return found;
}

struct Colour {
  std::vector<Piece> runs;
  std::vector<Piece> singles;
};
using Colouring = std::array<Colour, kColours>;

/// Gives pieces, in their order, the lowest colour that none of their particles has. Returns those without a free colour.
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

/// The largest difference of the numbers of two particles that a spring joins.
Index bandwidth(const Springs& springs, const std::vector<Index>& limited) {
  Index widest = 1;
  for (const Index s : limited) widest = std::max(widest, std::abs(springs.second[s] - springs.first[s]));
  return widest;
}

class Filler {
 public:
  /// The first ends of a batch's springs are at most about `span` apart.
  Filler(const SpringNetwork& network, Index span, SpringBatches& batches) : network_(network), span_(span), batches_(batches) {}

  void add_colour(Colour& colour) {
    std::vector<Piece> wide;
    for (const Piece& run : colour.runs) {
      const Index whole = run.count / kWideSimdWidth * kWideSimdWidth;
      if (whole > 0) wide.push_back({run.begin, whole});
      for (Index s = run.begin + whole; s < run.begin + run.count; ++s) colour.singles.push_back({s, 1});
    }
    add_runs(wide);
    std::ranges::stable_sort(colour.singles, {}, [&](const Piece& piece) { return network_.springs.first[piece.begin]; });
    add_singles(colour.singles);
  }

 private:
  /// A batch holds whole runs.
  void add_runs(std::span<const Piece> runs) {
    for (std::size_t begin = 0; begin < runs.size();) {
      const Index from = batches_.count();
      const auto first = [&](std::size_t i) { return network_.springs.first[runs[i].begin]; };
      std::size_t end = begin;
      do {
        const Piece& run = runs[end++];
        for (Index s = run.begin; s < run.begin + run.count; ++s) append(s);
      } while (end < runs.size() && batches_.count() + runs[end].count <= from + SpringBatches::kBatchSprings &&
               first(end) - first(begin) <= span_);
      end_batch(from, SpringBatches::Layout::runs);
      begin = end;
    }
  }

  void add_singles(std::span<const Piece> singles) {
    for (std::size_t begin = 0; begin < singles.size();) {
      const Index from = batches_.count();
      const std::size_t end = batch_end(singles, begin);
      for (std::size_t i = begin; i < end; ++i) append(singles[i].begin);
      while (batches_.count() % kSimdWidth != 0) append(singles[end - 1].begin);
      end_batch(from, SpringBatches::Layout::gathered);
      begin = end;
    }
  }

  /// The end of the largest batch of whole groups.
  [[nodiscard]] std::size_t batch_end(std::span<const Piece> singles, std::size_t begin) const {
    const auto first = [&](std::size_t i) { return network_.springs.first[singles[i].begin]; };
    const std::size_t most = std::min(singles.size(), begin + SpringBatches::kBatchSprings);
    std::size_t end = std::min(most, begin + kSimdWidth);
    while (end < most && first(end) - first(begin) <= span_) end = std::min(most, end + kSimdWidth);
    return end;
  }

  void append(Index s) {
    const Index a = network_.springs.first[s];
    const Index b = network_.springs.second[s];
    batches_.spring.push_back(s);
    batches_.first.push_back(a);
    batches_.second.push_back(b);
    batches_.rest_length.push_back(network_.springs.rest_length[s]);
    batches_.per_length.push_back(1.0 / network_.springs.rest_length[s]);
    batches_.first_share.push_back(network_.inverse_masses[a] / (network_.inverse_masses[a] + network_.inverse_masses[b]));
  }

  void end_batch(Index from, SpringBatches::Layout layout) {
    const auto same = [&](const std::vector<double>& values) {
      return std::all_of(values.begin() + from, values.end(), [&](double value) { return value == values[from]; });
    };
    batches_.batch.push_back({from, batches_.count(), layout, same(batches_.rest_length) && same(batches_.first_share)});
  }

  const SpringNetwork& network_;
  Index span_;
  SpringBatches& batches_;
};

}  // namespace

SpringBatches::SpringBatches(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  const std::vector<Index> limited = limited_springs(network, kinds);
  const Index band = bandwidth(network.springs, limited);
  const bool is_narrow = band <= network.particle_count() / kNarrow;
  Filler filler(network, is_narrow ? kSpan * band : network.particle_count(), *this);
  std::vector<Index> colour_begin{0};
  for (std::vector<Piece> waiting = pieces(network.springs, limited); !waiting.empty();) {
    Colouring colours;
    waiting = colour(network, waiting, colours);
    for (Colour& of_colour : colours) {
      if (of_colour.runs.empty() && of_colour.singles.empty()) break;
      filler.add_colour(of_colour);
      colour_begin.push_back(static_cast<Index>(batch.size()));
    }
  }
  if (is_narrow) {
    order_by_locality(colour_begin, band, network.particle_count(), *this);
  } else {
    order_by_colour(colour_begin, *this);
  }
}

}  // namespace sprung
