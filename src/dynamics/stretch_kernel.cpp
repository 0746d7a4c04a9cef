#include "dynamics/stretch_kernel.h"

#include "base/kernel.h"
#include "dynamics/packed_lanes.h"

#include <algorithm>
#include <cstddef>

namespace sprung {
namespace {

/// Of four springs.
struct Constants {
  SpringLanes first_share;
  SpringLanes per_most_squared;  ///< 1 / the square of the largest allowed length
};

[[gnu::always_inline]] inline void load(const StretchBatches& batches, Index s, double per_most_squared, Constants& constants) {
  SpringLanes per_length;
  load_lanes(&batches.first_share[s], constants.first_share);
  load_lanes(&batches.per_length[s], per_length);
  constants.per_most_squared = per_most_squared * (per_length * per_length);
}

/// Lengths as parts of the largest allowed one.
struct Lengths {
  SpringLanes squared;
  SpringLanes length;
};

/// Allowed lengths as parts of the largest allowed one, and that as a part of the rest length.
struct Limits {
  explicit Limits(const LengthRange& range)
      : most(range.most), per_most_squared(1.0 / (range.most * range.most)), least(range.least / range.most) {}

  double most;
  double per_most_squared;
  double least;
};

/// Finds the lengths; false where all are allowed, which is most of the time.
[[gnu::always_inline]] inline bool find_beyond(const Limits& limits, Lengths& springs) {
  const auto outside = (springs.squared > 1.0) | (springs.squared < limits.least * limits.least);
  if ((outside[0] | outside[1] | outside[2] | outside[3]) == 0) return false;
  springs.length = springs.squared;
  square_root(springs.length);
  return true;
}

[[gnu::always_inline]] inline void keep_largest(const Limits& limits, const Lengths& springs, SpringLanes& excess) {
  const SpringLanes too_long = springs.length - 1.0;
  const SpringLanes too_short = limits.least - springs.length;
  const SpringLanes larger = too_long > too_short ? too_long : too_short;
  excess = larger > excess ? larger : excess;
}

/// What the ends move, as parts of the way between them. A spring without length has no direction to be projected along: it stays.
struct Moves {
  SpringLanes first;
  SpringLanes second;
};

[[gnu::always_inline]] inline void find_moves(const Constants& constants, const Limits& limits, const Lengths& springs,
                                              double relaxation, Moves& moves) {
  const SpringLanes quotient = 1.0 / springs.length;
  const SpringLanes inverse = springs.length > 0.0 ? quotient : SpringLanes{};
  const SpringLanes too_long = 1.0 - inverse;
  const SpringLanes too_short = 1.0 - limits.least * inverse;
  const SpringLanes part =
      relaxation * ((too_long > 0.0 ? too_long : SpringLanes{}) + (too_short < 0.0 ? too_short : SpringLanes{}));
  moves.first = constants.first_share * part;
  moves.second = part - moves.first;
}

/// Four springs between consecutive particles and consecutive others.
struct RunGroup {
  std::ptrdiff_t first_at;  ///< in the positions
  std::ptrdiff_t second_at;
  Packed first;
  Packed second;
  Packed between;  ///< second - first
};

[[gnu::always_inline]] inline void load(const StretchBatches& batches, Index s, const double* positions, RunGroup& group,
                                        SpringLanes& squared) {
  group.first_at = std::ptrdiff_t{3} * batches.first[s];
  group.second_at = std::ptrdiff_t{3} * batches.second[s];
  load(positions + group.first_at, group.first);
  load(positions + group.second_at, group.second);
  subtract(group.second, group.first, group.between);
  SpringLanes x, y, z;
  unpack(group.between, x, y, z);
  squared = x * x + y * y + z * z;
}

[[gnu::always_inline]] inline void move(const Moves& moves, RunGroup& group, double* positions) {
  Packed of_first = group.between;
  Packed of_second = group.between;
  multiply(of_first, moves.first);
  multiply(of_second, moves.second);
  group.first.low += of_first.low;
  group.first.middle += of_first.middle;
  group.first.high += of_first.high;
  subtract(group.second, of_second, group.second);
  store(group.first, positions + group.first_at);
  store(group.second, positions + group.second_at);
}

/// Four springs that join eight consecutive particles two by two: see StretchBatches::Layout.
struct PairGroup {
  std::ptrdiff_t at;  ///< of its particles in the positions
  SpringLanes first[3];
  SpringLanes second[3];
  SpringLanes between[3];  ///< second - first
};

[[gnu::always_inline]] inline void load(const StretchBatches& batches, Index s, const double* positions, PairGroup& group,
                                        SpringLanes& squared) {
  group.at = std::ptrdiff_t{3} * batches.first[s];
  Packed low;
  Packed high;
  load(positions + group.at, low);
  load(positions + group.at + 3 * kSpringLanes, high);
  SpringLanes of_low[3];
  SpringLanes of_high[3];
  unpack(low, of_low[0], of_low[1], of_low[2]);
  unpack(high, of_high[0], of_high[1], of_high[2]);
  for (int i = 0; i < 3; ++i) {
    group.first[i] = __builtin_shufflevector(of_low[i], of_high[i], 0, 4, 2, 6);
    group.second[i] = __builtin_shufflevector(of_low[i], of_high[i], 1, 5, 3, 7);
    group.between[i] = group.second[i] - group.first[i];
  }
  squared = group.between[0] * group.between[0] + group.between[1] * group.between[1] + group.between[2] * group.between[2];
}

[[gnu::always_inline]] inline void move(const Moves& moves, PairGroup& group, double* positions) {
  SpringLanes of_low[3];
  SpringLanes of_high[3];
  for (int i = 0; i < 3; ++i) {
    group.first[i] += moves.first * group.between[i];
    group.second[i] -= moves.second * group.between[i];
    of_low[i] = __builtin_shufflevector(group.first[i], group.second[i], 0, 4, 2, 6);
    of_high[i] = __builtin_shufflevector(group.first[i], group.second[i], 1, 5, 3, 7);
  }
  Packed packed;
  pack(of_low[0], of_low[1], of_low[2], packed);
  store(packed, positions + group.at);
  pack(of_high[0], of_high[1], of_high[2], packed);
  store(packed, positions + group.at + 3 * kSpringLanes);
}

using Pair = double __attribute__((vector_size(2 * sizeof(double))));
using StoredPair = double __attribute__((vector_size(2 * sizeof(double)), aligned(alignof(double)), may_alias));

// Four lanes, the last one 0: fewer shuffles than gathering x, y and z of four particles.
[[gnu::always_inline]] inline void load(const double* from, SpringLanes& to) {
  const Pair xy = *reinterpret_cast<const StoredPair*>(from);
  const Pair z{from[2], 0.0};
  to = __builtin_shufflevector(xy, z, 0, 1, 2, 3);
}

[[gnu::always_inline]] inline void store(const SpringLanes& from, double* to) {
  *reinterpret_cast<StoredPair*>(to) = __builtin_shufflevector(from, from, 0, 1);
  to[2] = from[2];
}

/// Four springs between any particles.
struct GatheredGroup {
  std::ptrdiff_t first_at[kSpringLanes];  ///< in the positions
  std::ptrdiff_t second_at[kSpringLanes];
  SpringLanes first[kSpringLanes];
  SpringLanes second[kSpringLanes];
  SpringLanes between[kSpringLanes];  ///< second - first
};

[[gnu::always_inline]] inline void load(const StretchBatches& batches, Index s, const double* positions, GatheredGroup& group,
                                        SpringLanes& squared) {
  SpringLanes squares[kSpringLanes];
  for (Index k = 0; k < kSpringLanes; ++k) {
    group.first_at[k] = std::ptrdiff_t{3} * batches.first[s + k];
    group.second_at[k] = std::ptrdiff_t{3} * batches.second[s + k];
    load(positions + group.first_at[k], group.first[k]);
    load(positions + group.second_at[k], group.second[k]);
    group.between[k] = group.second[k] - group.first[k];
    squares[k] = group.between[k] * group.between[k];
  }
  const SpringLanes sums01 =
      __builtin_shufflevector(squares[0], squares[1], 0, 4, 2, 6) + __builtin_shufflevector(squares[0], squares[1], 1, 5, 3, 7);
  const SpringLanes sums23 =
      __builtin_shufflevector(squares[2], squares[3], 0, 4, 2, 6) + __builtin_shufflevector(squares[2], squares[3], 1, 5, 3, 7);
  squared = __builtin_shufflevector(sums01, sums23, 0, 1, 4, 5) + __builtin_shufflevector(sums01, sums23, 2, 3, 6, 7);
}

[[gnu::always_inline]] inline void move(const Moves& moves, GatheredGroup& group, double* positions) {
  for (Index k = 0; k < kSpringLanes; ++k) {
    group.first[k] += moves.first[k] * group.between[k];
    group.second[k] -= moves.second[k] * group.between[k];
    store(group.first[k], positions + group.first_at[k]);
    store(group.second[k], positions + group.second_at[k]);
  }
}

[[gnu::always_inline]] inline double largest(const SpringLanes& of) {
  return std::max(std::max(of[0], of[1]), std::max(of[2], of[3]));
}

template <class Group>
[[gnu::always_inline]] inline double project(const StretchBatches& batches, const StretchBatches::Part& part,
                                             const LengthRange& range, double relaxation, double* positions) {
  const Limits limits(range);
  Constants constants;
  load(batches, part.begin, limits.per_most_squared, constants);
  SpringLanes excess{};
  for (Index s = part.begin; s < part.end; s += kSpringLanes) {
    if (!part.same) load(batches, s, limits.per_most_squared, constants);
    Group group;
    Lengths springs;
    load(batches, s, positions, group, springs.squared);
    springs.squared *= constants.per_most_squared;
    if (!find_beyond(limits, springs)) continue;
    keep_largest(limits, springs, excess);
    Moves moves;
    find_moves(constants, limits, springs, relaxation, moves);
    move(moves, group, positions);
  }
  return limits.most * largest(excess);
}

// One square root for the longest and the shortest.
template <class Group>
[[gnu::always_inline]] inline double measure(const StretchBatches& batches, const StretchBatches::Part& part,
                                             const LengthRange& range, const double* positions) {
  Constants constants;
  load(batches, part.begin, 1.0, constants);
  SpringLanes longest{};
  SpringLanes shortest = SpringLanes{} + HUGE_VAL;
  for (Index s = part.begin; s < part.end; s += kSpringLanes) {
    if (!part.same) load(batches, s, 1.0, constants);
    Group group;
    SpringLanes squared;
    load(batches, s, positions, group, squared);
    squared *= constants.per_most_squared;
    longest = squared > longest ? squared : longest;
    shortest = squared < shortest ? squared : shortest;
  }
  const double most = std::sqrt(largest(longest));
  const double least = std::sqrt(-largest(-shortest));
  return std::max({0.0, most - range.most, range.least - least});
}

}  // namespace

SPRUNG_KERNEL
double project_springs(const StretchBatches& batches, const StretchBatches::Part& part, const LengthRange& range, double relaxation,
                       double* positions) {
  switch (part.layout) {
    case StretchBatches::Layout::run:
      return project<RunGroup>(batches, part, range, relaxation, positions);
    case StretchBatches::Layout::pairs:
      return project<PairGroup>(batches, part, range, relaxation, positions);
    default:
      return project<GatheredGroup>(batches, part, range, relaxation, positions);
  }
}

SPRUNG_KERNEL
double measure_springs(const StretchBatches& batches, const StretchBatches::Part& part, const LengthRange& range,
                       const double* positions) {
  switch (part.layout) {
    case StretchBatches::Layout::run:
      return measure<RunGroup>(batches, part, range, positions);
    case StretchBatches::Layout::pairs:
      return measure<PairGroup>(batches, part, range, positions);
    default:
      return measure<GatheredGroup>(batches, part, range, positions);
  }
}

}  // namespace sprung
