#include "dynamics/stretch_limit/stretch_kernel.h"

#include "base/machine/kernel.h"
#include "dynamics/stretch_limit/layout_gathered.h"
#include "dynamics/stretch_limit/layout_pairs.h"
#include "dynamics/stretch_limit/layout_runs.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

using Layout = SpringBatches::Layout;
using Batch = SpringBatches::Batch;

/// Squares of the longest and the shortest spring in each lane; the lanes are combined only at the end.
template <class Lanes>
struct Extremes {
  Lanes longest{};
  Lanes shortest = Lanes{} + HUGE_VAL;

  [[gnu::always_inline]] void include(const Lanes& longer, const Lanes& shorter) {
    longest = longer > longest ? longer : longest;
    shortest = shorter < shortest ? shorter : shortest;
  }

  [[gnu::always_inline]] void include_into(SquaredLengths& all) const {
    for (Index lane = 0; lane < kCountOf<Lanes>; ++lane) all.include({longest[lane], shortest[lane]});
  }
};

/// For batches whose springs fill `Wide` groups, and for the rest.
template <class Wide>
struct AllExtremes {
  Extremes<Wide> of_wide;
  Extremes<Double4> of_narrow;

  [[gnu::always_inline]] void include(const Extremes<Double8>& others) { of_wide.include(others.longest, others.shortest); }
  [[gnu::always_inline]] void include(const Extremes<Double4>& others) { of_narrow.include(others.longest, others.shortest); }

  [[gnu::always_inline]] SquaredLengths lengths() const {
    SquaredLengths all;
    of_wide.include_into(all);
    of_narrow.include_into(all);
    return all;
  }
};

[[gnu::always_inline]] inline bool are_beyond(const LengthRange& range, const Extremes<Double4>& springs) {
  const auto outside = (springs.longest > range.most * range.most) | (springs.shortest < range.least * range.least);
  return (outside[0] | outside[1] | outside[2] | outside[3]) != 0;
}

[[gnu::always_inline]] inline bool are_beyond(const LengthRange& range, const Extremes<Double8>& springs) {
  const auto half = [](const Double8& of, Double4& low, Double4& high) {
    low = __builtin_shufflevector(of, of, 0, 1, 2, 3);
    high = __builtin_shufflevector(of, of, 4, 5, 6, 7);
  };
  Extremes<Double4> some;
  Extremes<Double4> others;
  half(springs.longest, some.longest, others.longest);
  half(springs.shortest, some.shortest, others.shortest);
  some.include(others.longest, others.shortest);
  return are_beyond(range, some);
}

/// Squared lengths of a batch's springs from `s` on, relative to the rest length, while they fill a group. Returns the first that
/// does not. Without `lengths` only the extremes are kept.
template <class Group>
[[gnu::always_inline]] inline Index find_squared(const SpringBatches& batches, const Batch& batch, Index s, const double* positions,
                                                 double* lengths, Extremes<typename Group::Lanes>& extremes) {
  using Lanes = typename Group::Lanes;
  if (s + kCountOf < Lanes >> batch.end) return s;
  Lanes per_length;
  load_simd(&batches.per_length[s], per_length);
  for (; s + kCountOf<Lanes> <= batch.end; s += kCountOf<Lanes>) {
    if (!batch.same) load_simd(&batches.per_length[s], per_length);
    Lanes squared;
    Group::find_squared(batches, s, positions, squared);
    squared *= per_length * per_length;
    extremes.include(squared, squared);
    if (lengths != nullptr) store_simd(squared, lengths + (s - batch.begin));
  }
  return s;
}

/// Turns squared lengths into corrections 1 - allowed / length: of springs that are too long in `lengths`, and of those that are
/// too short in `pushes`, at most their own length, unless there are none.
template <class Lanes>
[[gnu::always_inline]] inline Index find_beyond(const LengthRange& range, double relaxation, Index i, Index count, double* lengths,
                                                double* pushes) {
  const double most_squared = range.most * range.most;
  const double least_squared = range.least * range.least;
  for (; i + kCountOf<Lanes> <= count; i += kCountOf<Lanes>) {
    Lanes squared, inverse;
    load_simd(lengths + i, squared);
    inverse_root(squared, inverse);
    const Lanes too_long = 1.0 - range.most * inverse;
    store_simd(relaxation * (squared > most_squared ? too_long : Lanes{}), lengths + i);
    if (pushes == nullptr) continue;
    const Lanes too_short = 1.0 - range.least * inverse;
    const Lanes push = too_short > -1.0 ? too_short : Lanes{} - 1.0;
    store_simd(relaxation * (squared < least_squared ? push : Lanes{}), pushes + i);
  }
  return i;
}

/// The displacements of the ends.
template <class Lanes>
[[gnu::always_inline]] inline void load_moves(const double* beyond, const Lanes& first_share, Moves<Lanes>& moves) {
  load_simd(beyond, moves.second);
  moves.first = first_share * moves.second;
  moves.second -= moves.first;
}

template <class Group>
[[gnu::always_inline]] inline Index move(const SpringBatches& batches, const Batch& batch, Index s, const double* too_long,
                                         const double* too_short, const double* before, double* positions) {
  using Lanes = typename Group::Lanes;
  if (s + kCountOf < Lanes >> batch.end) return s;
  Lanes first_share;
  load_simd(&batches.first_share[s], first_share);
  for (; s + kCountOf<Lanes> <= batch.end; s += kCountOf<Lanes>) {
    if (!batch.same) load_simd(&batches.first_share[s], first_share);
    Moves<Lanes> pulls;
    load_moves(too_long + (s - batch.begin), first_share, pulls);
    if (too_short == nullptr) {
      Group::move(batches, s, pulls, NoPushes{}, before, positions);
      continue;
    }
    Moves<Lanes> pushes;
    load_moves(too_short + (s - batch.begin), first_share, pushes);
    Group::move(batches, s, pulls, pushes, before, positions);
  }
  return s;
}

// Three sweeps over a batch, which stays in the first-level cache. In a single sweep each spring would wait for its own square
// root, and hardware does not look far enough ahead to start the next. Springs that do not fill a wide group use narrow ones.
template <class Wide, class Narrow, class All>
[[gnu::always_inline]] inline void project(const SpringBatches& batches, const Batch& batch, const LengthRange& range,
                                           double relaxation, const double* before, double* positions, All& extremes) {
  alignas(Double8) double lengths[SpringBatches::kBatchSprings];
  Extremes<typename Wide::Lanes> of_wide;
  Extremes<typename Narrow::Lanes> of_narrow;
  const Index measured = find_squared<Wide>(batches, batch, batch.begin, positions, lengths, of_wide);
  find_squared<Narrow>(batches, batch, measured, positions, lengths, of_narrow);
  if (!are_beyond(range, of_wide) && !are_beyond(range, of_narrow)) return;
  extremes.include(of_wide);
  extremes.include(of_narrow);

  const LengthRange least_alone{.least = range.least, .most = HUGE_VAL};
  alignas(Double8) double pushes[SpringBatches::kBatchSprings];
  double* const too_short = are_beyond(least_alone, of_wide) || are_beyond(least_alone, of_narrow) ? pushes : nullptr;
  const Index count = batch.end - batch.begin;
  const Index found = find_beyond<typename Wide::Lanes>(range, relaxation, 0, count, lengths, too_short);
  find_beyond<typename Narrow::Lanes>(range, relaxation, found, count, lengths, too_short);
  const Index moved = move<Wide>(batches, batch, batch.begin, lengths, too_short, before, positions);
  move<Narrow>(batches, batch, moved, lengths, too_short, before, positions);
}

/// Calls `body` with the groups of each batch.
template <class Widest, class Body>
[[gnu::always_inline]] inline void for_batches(const SpringBatches& batches, const BatchRange& batch_range, const Body& body) {
  for (Index p = batch_range.begin; p < batch_range.end; ++p) {
    const Batch& batch = batches.batch[p];
    switch (batch.layout) {
      case Layout::runs_of_eight:  // NOLINT(bugprone-branch-clone): two are alike where the widest vectors hold four
        body.template operator()<RunGroup<Widest>, RunGroup<PackedVectors4>>(batch);
        break;
      case Layout::runs_of_four:
        body.template operator()<RunGroup<PackedVectors4>, RunGroup<PackedVectors4>>(batch);
        break;
      case Layout::runs_of_three:
        body.template operator()<RunGroup<PackedVectors4, 3>, RunGroup<PackedVectors4, 3>>(batch);
        break;
      case Layout::runs_of_two:
        body.template operator()<RunGroup<PackedVectors4, 2>, RunGroup<PackedVectors4, 2>>(batch);
        break;
      case Layout::pairs:
        body.template operator()<PairGroup<Widest>, PairGroup<PackedVectors4>>(batch);
        break;
      default:
        body.template operator()<GatheredGroup, GatheredGroup>(batch);
    }
  }
}

template <class Widest>
[[gnu::always_inline]] inline SquaredLengths project_batches(const SpringBatches& batches, const BatchRange& batch_range,
                                                             const LengthRange& range, double relaxation, const double* before,
                                                             double* positions) {
  AllExtremes<typename Widest::Lanes> extremes;
  for_batches<Widest>(
      batches, batch_range, [&]<class Wide, class Narrow>(const Batch& batch) __attribute__((always_inline)) {
        project<Wide, Narrow>(batches, batch, range, relaxation, before, positions, extremes);
      });
  return extremes.lengths();
}

template <class Widest>
[[gnu::always_inline]] inline SquaredLengths measure_batches(const SpringBatches& batches, const BatchRange& batch_range,
                                                             const double* positions) {
  AllExtremes<typename Widest::Lanes> extremes;
  for_batches<Widest>(
      batches, batch_range, [&]<class Wide, class Narrow>(const Batch& batch) __attribute__((always_inline)) {
        Extremes<typename Wide::Lanes> of_wide;
        const Index measured = find_squared<Wide>(batches, batch, batch.begin, positions, nullptr, of_wide);
        extremes.include(of_wide);
        find_squared<Narrow>(batches, batch, measured, positions, nullptr, extremes.of_narrow);
      });
  return extremes.lengths();
}

}  // namespace

SPRUNG_KERNEL
SquaredLengths project_springs_narrow(const SpringBatches& batches, const BatchRange& batch_range, const LengthRange& range,
                                      double relaxation, const double* before, double* positions) {
  return project_batches<PackedVectors4>(batches, batch_range, range, relaxation, before, positions);
}

SPRUNG_KERNEL
SquaredLengths measure_springs_narrow(const SpringBatches& batches, const BatchRange& batch_range, const double* positions) {
  return measure_batches<PackedVectors4>(batches, batch_range, positions);
}

SPRUNG_WIDE_KERNEL
SquaredLengths project_springs_wide(const SpringBatches& batches, const BatchRange& batch_range, const LengthRange& range,
                                    double relaxation, const double* before, double* positions) {
  return project_batches<PackedVectors8>(batches, batch_range, range, relaxation, before, positions);
}

SPRUNG_WIDE_KERNEL
SquaredLengths measure_springs_wide(const SpringBatches& batches, const BatchRange& batch_range, const double* positions) {
  return measure_batches<PackedVectors8>(batches, batch_range, positions);
}

}  // namespace sprung
