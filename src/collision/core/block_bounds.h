// Particles in blocks of neighbours in number, which are neighbours in space: the broad phase is asked once a block.
#pragma once

#include "base/parallel.h"

#include <span>
#include <utility>
#include <vector>

namespace sprung {

inline constexpr Index kBlockParticles = 64;

/// Runs `work(begin, end, results)` for each block of particles, in parallel, and returns all results in the order of the blocks:
/// the same for any number of threads.
template <class Result, class Work>
std::vector<Result> collect_from_blocks(Index particles, const Work& work) {
  constexpr Index kChunk = 4 * kBlockParticles;  // a task's worth of work
  std::vector<std::vector<Result>> parts(static_cast<std::size_t>((particles + kChunk - 1) / kChunk));
  parallel_chunks(particles, kChunk, [&](Index begin, Index end) {
    std::vector<Result>& results = parts[static_cast<std::size_t>(begin / kChunk)];
    for (; begin < end; begin += kBlockParticles) work(begin, std::min(begin + kBlockParticles, end), results);
  });
  std::size_t count = 0;
  for (const std::vector<Result>& part : parts) count += part.size();
  std::vector<Result> all;
  all.reserve(count);
  for (const std::vector<Result>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// A box around particles [begin, end), or around those listed, that leaves out positions that are not finite; empty around none.
[[nodiscard]] Box3 finite_bounds(const Points& positions, Index begin, Index end);
[[nodiscard]] Box3 finite_bounds(const Points& positions, std::span<const Index> particles);

/// The box, `distance` [m] larger on every side, and by what rounding may do to it.
[[nodiscard]] Box3 grown(const Box3& box, double distance);

}  // namespace sprung
