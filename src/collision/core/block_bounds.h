// Blocks of consecutive particles, which are neighbours in space: the broad phase is queried once per block.
#pragma once

#include "base/parallel.h"

#include <span>
#include <utility>
#include <vector>

namespace sprung {

inline constexpr Index kBlockParticles = 64;

/// Runs `work(begin, end, results)` for each block of particles, in parallel, and returns all results in the order of the blocks.
/// The result does not depend on the number of threads.
template <class Result, class Work>
std::vector<Result> collect_from_blocks(Index particles, const Work& work) {
  constexpr Index kChunk = 4 * kBlockParticles;  // particles per task
  std::vector<std::vector<Result>> chunks(static_cast<std::size_t>((particles + kChunk - 1) / kChunk));
  parallel_chunks(particles, kChunk, [&](Index begin, Index end) {
    std::vector<Result>& results = chunks[static_cast<std::size_t>(begin / kChunk)];
    for (; begin < end; begin += kBlockParticles) work(begin, std::min(begin + kBlockParticles, end), results);
  });
  std::size_t count = 0;
  for (const std::vector<Result>& chunk : chunks) count += chunk.size();
  std::vector<Result> all;
  all.reserve(count);
  for (const std::vector<Result>& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

/// The box around particles [begin, end), or around those listed. Positions that are not finite are left out; the box is empty if
/// none is left.
[[nodiscard]] Box3 finite_bounds(const Points& positions, Index begin, Index end);
[[nodiscard]] Box3 finite_bounds(const Points& positions, std::span<const Index> particles);

/// The box, larger by `distance` [m] and a bound of the rounding error on every side.
[[nodiscard]] Box3 grown(const Box3& box, double distance);

}  // namespace sprung
