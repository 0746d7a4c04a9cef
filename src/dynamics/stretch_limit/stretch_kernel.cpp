#include "dynamics/stretch_limit/stretch_kernel.h"

#include "base/machine/kernel.h"
#include "dynamics/stretch_limit/layout_gathered.h"
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

/// Of batches with `Wide` groups, and with narrow ones.
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

/// Squared lengths of a batch's springs, relative to the rest length. Without `lengths` only the extremes are kept.
template <class Group>
[[gnu::always_inline]] inline void find_squared(const SpringBatches& batches, const Batch& batch, const double* positions,
                                                double* lengths, Extremes<typename Group::Lanes>& extremes) {
  using Lanes = typename Group::Lanes;
  Lanes per_length;
  load_simd(&batches.per_length[batch.begin], per_length);
  for (Index s = batch.begin; s < batch.end; s += kCountOf<Lanes>) {
    if (!batch.same) load_simd(&batches.per_length[s], per_length);
    Lanes squared;
    Group::find_squared(batches, s, positions, squared);
    squared *= per_length * per_length;
    extremes.include(squared, squared);
    if (lengths != nullptr) store_simd(squared, lengths + (s - batch.begin));
  }
}

/// Turns squared lengths into corrections 1 - allowed / length: of springs that are too long in `lengths`, and of those that are
/// too short in `pushes`, at most their own length, unless there are none.
template <class Lanes>
[[gnu::always_inline]] inline void find_beyond(const LengthRange& range, double relaxation, Index count, double* lengths,
                                               double* pushes) {
  const double most_squared = range.most * range.most;
  const double least_squared = range.least * range.least;
  for (Index i = 0; i < count; i += kCountOf<Lanes>) {
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
}

/// The displacements of the ends.
template <class Lanes>
[[gnu::always_inline]] inline void load_moves(const double* beyond, const Lanes& first_share, Moves<Lanes>& moves) {
  load_simd(beyond, moves.second);
  moves.first = first_share * moves.second;
  moves.second -= moves.first;
}

template <class Group>
[[gnu::always_inline]] inline void move(const SpringBatches& batches, const Batch& batch, const double* too_long,
                                        const double* too_short, const double* before, double* positions) {
  using Lanes = typename Group::Lanes;
  Lanes first_share;
  load_simd(&batches.first_share[batch.begin], first_share);
  for (Index s = batch.begin; s < batch.end; s += kCountOf<Lanes>) {
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
}

// Three sweeps over a batch, which stays in the first-level cache. In a single sweep each spring would wait for its own square
// root, and hardware does not look far enough ahead to start the next.
template <class Group, class All>
[[gnu::always_inline]] inline void project(const SpringBatches& batches, const Batch& batch, const LengthRange& range,
                                           double relaxation, const double* before, double* positions, All& extremes) {
  using Lanes = typename Group::Lanes;
  alignas(Double8) double lengths[SpringBatches::kBatchSprings];
  Extremes<Lanes> of_batch;
  find_squared<Group>(batches, batch, positions, lengths, of_batch);
  if (!are_beyond(range, of_batch)) return;
  extremes.include(of_batch);

  const LengthRange least_alone{.least = range.least, .most = HUGE_VAL};
  alignas(Double8) double pushes[SpringBatches::kBatchSprings];
  double* const too_short = are_beyond(least_alone, of_batch) ? pushes : nullptr;
  find_beyond<Lanes>(range, relaxation, batch.end - batch.begin, lengths, too_short);
  move<Group>(batches, batch, lengths, too_short, before, positions);
}

/// Calls `body` with the groups of each batch.
template <class Widest, class Body>
[[gnu::always_inline]] inline void for_batches(const SpringBatches& batches, const BatchRange& batch_range, const Body& body) {
  for (Index p = batch_range.begin; p < batch_range.end; ++p) {
    const Batch& batch = batches.batch[p];
    if (batch.layout == Layout::runs) {
      body.template operator()<RunGroup<Widest>>(batch);
    } else {
      body.template operator()<GatheredGroup>(batch);
    }
  }
}

template <class Widest>
[[gnu::always_inline]] inline SquaredLengths project_batches(const SpringBatches& batches, const BatchRange& batch_range,
                                                             const LengthRange& range, double relaxation, const double* before,
                                                             double* positions) {
  AllExtremes<typename Widest::Lanes> extremes;
  for_batches<Widest>(
      batches, batch_range, [&]<class Group>(const Batch& batch) __attribute__((always_inline)) {
        project<Group>(batches, batch, range, relaxation, before, positions, extremes);
      });
  return extremes.lengths();
}

template <class Widest>
[[gnu::always_inline]] inline SquaredLengths measure_batches(const SpringBatches& batches, const BatchRange& batch_range,
                                                             const double* positions) {
  AllExtremes<typename Widest::Lanes> extremes;
  for_batches<Widest>(
      batches, batch_range, [&]<class Group>(const Batch& batch) __attribute__((always_inline)) {
        Extremes<typename Group::Lanes> of_batch;
        find_squared<Group>(batches, batch, positions, nullptr, of_batch);
        extremes.include(of_batch);
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
