#include "dynamics/forces/spring_plan.h"

#include <algorithm>
#include <bit>

namespace sprung {
namespace {

// The particles of a block stay in the second-level cache. Smaller blocks compute more springs twice.
constexpr Index kSmallestBlock = 1024;
constexpr Index kLargestBlock = 16384;
constexpr Index kWantedBlocks = 16;

// Shorter runs cost more than gathering the particles one by one.
constexpr Index kShortestRun = 8;
static_assert(kShortestRun >= kSimdWidth && kSpringBatch >= 2 * kSimdWidth);

/// A power of two that depends on the number of particles alone.
Index block_size(Index particles) {
  const auto share = std::bit_ceil(static_cast<std::uint32_t>(particles / kWantedBlocks));
  return std::clamp(static_cast<Index>(share), kSmallestBlock, kLargestBlock);
}

/// Spring + i joins first + i and second + i for all i in [begin, end).
struct Line {
  Index first;
  Index second;
  Index spring;
  Index begin;
  Index end;
};

/// Whether each spring moves a particle. Springs of a stretch limit alone have no stiffness and no damping, hence no force.
std::vector<char> springs_that_pull(const SpringNetwork& network, const std::vector<double>& stiffness,
                                    const std::vector<double>& damping) {
  const Springs& springs = network.springs;
  std::vector<char> pulls;
  for (Index s = 0; s < springs.count(); ++s) {
    const bool sleeps = network.is_asleep(springs.first[s]) && network.is_asleep(springs.second[s]);
    pulls.push_back(!sleeps && (stiffness[s] > 0.0 || damping[s] > 0.0) ? 1 : 0);
  }
  return pulls;
}

/// The longest line of springs that begins with `spring`.
Line line_from(const Springs& springs, const std::vector<char>& pulls, Index spring) {
  const Index a = springs.first[spring];
  const Index b = springs.second[spring];
  const bool tension_only = springs.law(spring).tension_only;
  Index count = 1;
  while (spring + count < springs.count() && springs.first[spring + count] == a + count &&
         springs.second[spring + count] == b + count && pulls[spring + count] != 0 &&
         springs.law(spring + count).tension_only == tension_only) {
    ++count;
  }
  return {a, b, spring, 0, count};
}

class Planner {
 public:
  Planner(const Springs& springs, const std::vector<double>& stiffness, const std::vector<double>& damping, Index block_size,
          std::vector<SpringPlan::Block>& blocks)
      : springs_(springs), stiffness_(stiffness), damping_(damping), size_(block_size), blocks_(blocks) {}

  // Cuts a line where one of its ends enters another block. Each piece then concerns one pair of blocks.
  void add(const Line& line) {
    for (Index i = line.begin; i < line.end;) {
      const Index first_block = (line.first + i) / size_;
      const Index second_block = (line.second + i) / size_;
      const Index end = std::min({line.end, (first_block + 1) * size_ - line.first, (second_block + 1) * size_ - line.second});
      const Line section{line.first, line.second, line.spring, i, end};
      add_section(blocks_[first_block], section, true, first_block == second_block);
      if (first_block != second_block) add_section(blocks_[second_block], section, false, true);
      i = end;
    }
  }

 private:
  void add_section(SpringPlan::Block& block, const Line& section, bool writes_first, bool writes_second) const {
    const bool tension_only = springs_.law(section.spring).tension_only;
    if (section.end - section.begin < kShortestRun) {
      auto& singles = tension_only ? block.tension_only_singles : block.singles;
      for (Index i = section.begin; i < section.end; ++i) {
        singles.push_back({section.first + i, section.second + i, section.spring + i, writes_first, writes_second});
      }
      return;
    }
    for (Index i = section.begin; i < section.end;) {
      const Index count = batch_size(section.end - i);
      const Index spring = section.spring + i;
      block.runs.push_back({section.first + i, section.second + i, spring, count, writes_first, writes_second,
                            all_same(springs_.rest_length, spring, count) && !any_yields(spring, count),
                            all_same(stiffness_, spring, count), all_same(damping_, spring, count), tension_only,
                            springs_.rest_length[spring], stiffness_[spring], damping_[spring]});
      i += count;
    }
  }

  // The rest must fill the kernel's registers too.
  static Index batch_size(Index springs) {
    if (springs <= kSpringBatch) return springs;
    return std::min(kSpringBatch, springs - kSimdWidth);
  }

  static bool all_same(const std::vector<double>& values, Index begin, Index count) {
    const auto first = values.begin() + begin;
    return std::all_of(first, first + count, [&](double value) { return value == *first; });
  }

  [[nodiscard]] bool any_yields(Index begin, Index count) const {
    if (springs_.laws.empty()) return false;
    const auto first = springs_.laws.begin() + begin;
    return std::any_of(first, first + count, [](const SpringLaw& law) { return law.yields(); });
  }

  const Springs& springs_;
  const std::vector<double>& stiffness_;
  const std::vector<double>& damping_;
  Index size_;
  std::vector<SpringPlan::Block>& blocks_;
};

}  // namespace

SpringPlan::SpringPlan(const SpringNetwork& network, const std::vector<double>& stiffness, const std::vector<double>& damping) {
  const Index size = block_size(network.particle_count());
  blocks.resize(network.particle_count() / size + 1);
  Planner planner(network.springs, stiffness, damping, size, blocks);
  const std::vector<char> pulls = springs_that_pull(network, stiffness, damping);
  for (Index s = 0; s < network.springs.count();) {
    if (pulls[s] == 0) {
      ++s;
      continue;
    }
    const Line line = line_from(network.springs, pulls, s);
    planner.add(line);
    s += line.end;
  }
  std::erase_if(
      blocks, [](const Block& block) { return block.runs.empty() && block.singles.empty() && block.tension_only_singles.empty(); });
  // Springs of all kinds that begin at the same particles follow each other, so that the particles are in the first-level cache
  // for all of them.
  for (Block& block : blocks) {
    std::ranges::stable_sort(block.runs, {}, &Run::first);
    std::ranges::stable_sort(block.singles, {}, &Single::first);
    std::ranges::stable_sort(block.tension_only_singles, {}, &Single::first);
  }
}

}  // namespace sprung
