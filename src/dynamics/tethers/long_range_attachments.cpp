#include "dynamics/tethers/long_range_attachments.h"

#include "base/parallel.h"
#include "dynamics/tethers/lra_paths.h"

#include <algorithm>
#include <tuple>

namespace sprung {
namespace {

// The particles of a block stay in the first-level cache while all groups of pins act on them.
constexpr Index kBlock = 1024;
constexpr Index kBlocksPerChunk = 4;

Index block_of(const Tether& tether) { return tether.particle / kBlock; }

/// The longest run from tether t on.
LraRun run_from(const std::vector<Tether>& tethers, std::size_t t) {
  const Tether& first = tethers[t];
  const auto follows = [&](std::size_t i, bool one_pin) {
    if (t + i >= tethers.size()) return false;
    const Tether& next = tethers[t + i];
    const auto offset = static_cast<Index>(i);
    return block_of(next) == block_of(first) && next.group == first.group && next.particle == first.particle + offset &&
           next.pin == (one_pin ? first.pin : first.pin + offset);
  };
  const bool one_pin = !follows(1, false);
  std::size_t count = 1;
  while (follows(count, one_pin)) ++count;
  return {first.particle, first.pin, static_cast<Index>(t), static_cast<Index>(count), one_pin};
}

}  // namespace

LongRangeAttachments::LongRangeAttachments(const SpringNetwork& network, const std::vector<SpringKind>& kinds, double max_stretch) {
  std::vector<Tether> tethers = find_tethers(network, kinds);
  if (tethers.empty()) return;
  std::ranges::stable_sort(tethers, {},
                           [](const Tether& tether) { return std::tuple(block_of(tether), tether.group, tether.particle); });
  lengths_.reserve(tethers.size());
  for (const Tether& tether : tethers) lengths_.push_back((1.0 + max_stretch) * tether.length);
  for (std::size_t t = 0; t < tethers.size(); t += static_cast<std::size_t>(runs_.back().count)) {
    if (t == 0 || block_of(tethers[t]) != block_of(tethers[t - 1])) begin_.push_back(static_cast<Index>(runs_.size()));
    runs_.push_back(run_from(tethers, t));
  }
  begin_.push_back(static_cast<Index>(runs_.size()));
}

void LongRangeAttachments::project(Points& positions) const {
  if (runs_.empty()) return;
  parallel_chunks(static_cast<Index>(begin_.size()) - 1, kBlocksPerChunk, [&](Index begin, Index end) {
    for (Index run = begin_[begin]; run < begin_[end]; ++run) project_tethers(runs_[run], lengths_.data(), positions.data());
  });
}

// One run after the other: its particles differ, so that each moved by one tether.
void LongRangeAttachments::project(Points& positions, const Scalars& masses, const ImpulseRecorder& recorder) const {
  for (const LraRun& run : runs_) {
    const Points before = positions.middleCols(run.particle, run.count);
    project_tethers(run, lengths_.data(), positions.data());
    for (Index i = 0; i < run.count; ++i) {
      const Vector3 moved = positions.col(run.particle + i) - before.col(i);
      recorder.add_to_pinned(run.one_pin ? run.pin : run.pin + i, -masses[run.particle + i] * moved);
    }
  }
}

}  // namespace sprung
