// Groups of neighbouring points by bisection, blocks of consecutive particles, which are neighbours in space too, and parallel
// searches that collect results. The broad phase is queried once per block.
#pragma once

#include "base/parallel.h"
#include "base/types.h"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace sprung {

/// Sorts order[begin, end), which are columns of `middles` [m], into consecutive groups of neighbours; within a group they ascend.
/// The groups are as few as possible with at most `most` members, and nearly equal in size. Appends the begin of each group. The
/// first half of the groups is separated from the second by the first cut, and so on, so that a balanced tree over the groups
/// bounds neighbours. Requires most > 0.
void bisect(const Points& middles, std::size_t most, std::vector<Index>& order, std::size_t begin, std::size_t end,
            std::vector<std::size_t>& starts);

inline constexpr Index kBlockParticles = 64;

/// Runs `work(begin, end, results)` for each chunk of [0, count), in parallel, and returns all results in the order of the chunks.
/// The result does not depend on the number of threads.
template <class Result, class Work>
std::vector<Result> collect_from_chunks(Index count, Index chunk, const Work& work) {
  std::vector<std::vector<Result>> chunks(static_cast<std::size_t>((count + chunk - 1) / chunk));
  parallel_chunks(count, chunk, [&](Index begin, Index end) { work(begin, end, chunks[static_cast<std::size_t>(begin / chunk)]); });
  std::size_t total = 0;
  for (const std::vector<Result>& results : chunks) total += results.size();
  std::vector<Result> all;
  all.reserve(total);
  for (const std::vector<Result>& results : chunks) all.insert(all.end(), results.begin(), results.end());
  return all;
}

/// The same for each block of particles.
template <class Result, class Work>
std::vector<Result> collect_from_blocks(Index particles, const Work& work) {
  return collect_from_chunks<Result>(particles, 4 * kBlockParticles, [&](Index begin, Index end, std::vector<Result>& results) {
    for (; begin < end; begin += kBlockParticles) work(begin, std::min(begin + kBlockParticles, end), results);
  });
}

/// The box around particles [begin, end), or around those listed. Positions that are not finite are left out; the box is empty if
/// none is left.
[[nodiscard]] Box3 finite_bounds(const Points& positions, Index begin, Index end);
[[nodiscard]] Box3 finite_bounds(const Points& positions, std::span<const Index> particles);

/// The box, larger by `distance` [m] and a bound of the rounding error on every side.
[[nodiscard]] Box3 grown(const Box3& box, double distance);

}  // namespace sprung
