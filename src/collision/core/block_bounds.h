// Parallel searches that collect results, and blocks of consecutive particles, which are neighbours in space: the broad phase is
// queried once per block.
#pragma once

#include "base/parallel.h"

#include <span>
#include <utility>
#include <vector>

namespace sprung {

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
