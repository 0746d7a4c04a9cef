#include "dynamics/stretch_kernel.h"

#include "base/kernel.h"
#include "dynamics/packed_lanes.h"

#include <algorithm>

namespace sprung {
namespace {

// Constants that all springs of a part share are read once, at its first spring: `constants` is that or the spring's own number.

/// Four springs.
struct Lengths {
  SpringLanes squared;
  SpringLanes length;
  SpringLanes beyond;  ///< what the lengths have too much, negative where they are too short [m]
};

/// Finds what is beyond the range; false where nothing is. Most springs are within their limits most of the time: they need no
/// square root.
[[gnu::always_inline]] inline bool find_beyond(const StretchBatches& batches, Index constants, const LengthRange& range,
                                               Lengths& springs) {
  SpringLanes rest_length;
  load_lanes(&batches.rest_length[constants], rest_length);
  const SpringLanes most = range.most * rest_length;
  const SpringLanes least = range.least * rest_length;
  const auto outside = (springs.squared > most * most) | (springs.squared < least * least);
  if ((outside[0] | outside[1] | outside[2] | outside[3]) == 0) return false;
  springs.length = springs.squared;
  square_root(springs.length);
  const SpringLanes too_long = springs.length - most;
  const SpringLanes too_short = springs.length - least;
  springs.beyond = too_long > 0.0 ? too_long : (too_short < 0.0 ? too_short : SpringLanes{});
  return true;
}

[[gnu::always_inline]] inline void keep_largest(const StretchBatches& batches, Index constants, const Lengths& springs,
                                                SpringLanes& excess) {
  SpringLanes per_length;
  load_lanes(&batches.per_length[constants], per_length);
  const SpringLanes part = (springs.beyond < 0.0 ? -springs.beyond : springs.beyond) * per_length;
  excess = part > excess ? part : excess;
}

/// What the ends move, as parts of the way between them. A spring without length has no direction to be projected along: it stays.
struct Moves {
  SpringLanes first;
  SpringLanes second;
};

[[gnu::always_inline]] inline void find_moves(const StretchBatches& batches, Index constants, const Lengths& springs,
                                              double relaxation, Moves& moves) {
  SpringLanes first_share;
  load_lanes(&batches.first_share[constants], first_share);
  const SpringLanes quotient = relaxation * springs.beyond / springs.length;
  const SpringLanes part = springs.length > 0.0 ? quotient : SpringLanes{};
  moves.first = first_share * part;
  moves.second = (1.0 - first_share) * part;
}

/// Four springs between consecutive particles.
struct RunGroup {
  Packed first;
  Packed second;
  Packed between;  ///< second - first
};

[[gnu::always_inline]] inline void load(const StretchBatches& batches, Index s, const double* positions, RunGroup& group,
                                        Lengths& springs) {
  load(positions + 3 * batches.first[s], group.first);
  load(positions + 3 * batches.second[s], group.second);
  subtract(group.second, group.first, group.between);
  SpringLanes x, y, z;
  unpack(group.between, x, y, z);
  springs.squared = x * x + y * y + z * z;
}

[[gnu::always_inline]] inline void move(const StretchBatches& batches, Index s, const Moves& moves, RunGroup& group,
                                        double* positions) {
  Packed of_first = group.between;
  Packed of_second = group.between;
  multiply(of_first, moves.first);
  multiply(of_second, moves.second);
  group.first.low += of_first.low;
  group.first.middle += of_first.middle;
  group.first.high += of_first.high;
  subtract(group.second, of_second, group.second);
  store(group.first, positions + 3 * batches.first[s]);
  store(group.second, positions + 3 * batches.second[s]);
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
  SpringLanes first[kSpringLanes];
  SpringLanes second[kSpringLanes];
  SpringLanes between[kSpringLanes];  ///< second - first
};

[[gnu::always_inline]] inline void load(const StretchBatches& batches, Index s, const double* positions, GatheredGroup& group,
                                        Lengths& springs) {
  SpringLanes squares[kSpringLanes];
  for (Index k = 0; k < kSpringLanes; ++k) {
    load(positions + 3 * batches.first[s + k], group.first[k]);
    load(positions + 3 * batches.second[s + k], group.second[k]);
    group.between[k] = group.second[k] - group.first[k];
    squares[k] = group.between[k] * group.between[k];
  }
  const SpringLanes sums01 =
      __builtin_shufflevector(squares[0], squares[1], 0, 4, 2, 6) + __builtin_shufflevector(squares[0], squares[1], 1, 5, 3, 7);
  const SpringLanes sums23 =
      __builtin_shufflevector(squares[2], squares[3], 0, 4, 2, 6) + __builtin_shufflevector(squares[2], squares[3], 1, 5, 3, 7);
  springs.squared = __builtin_shufflevector(sums01, sums23, 0, 1, 4, 5) + __builtin_shufflevector(sums01, sums23, 2, 3, 6, 7);
}

[[gnu::always_inline]] inline void move(const StretchBatches& batches, Index s, const Moves& moves, GatheredGroup& group,
                                        double* positions) {
  for (Index k = 0; k < kSpringLanes; ++k) {
    group.first[k] += moves.first[k] * group.between[k];
    group.second[k] -= moves.second[k] * group.between[k];
    store(group.first[k], positions + 3 * batches.first[s + k]);
    store(group.second[k], positions + 3 * batches.second[s + k]);
  }
}

[[gnu::always_inline]] inline double largest(const SpringLanes& of) {
  return std::max(std::max(of[0], of[1]), std::max(of[2], of[3]));
}

template <class Group>
[[gnu::always_inline]] inline double project(const StretchBatches& batches, const StretchBatches::Part& part,
                                             const LengthRange& range, double relaxation, double* positions) {
  SpringLanes excess{};
  for (Index s = part.begin; s < part.end; s += kSpringLanes) {
    const Index constants = part.same ? part.begin : s;
    Group group;
    Lengths springs;
    load(batches, s, positions, group, springs);
    if (!find_beyond(batches, constants, range, springs)) continue;
    keep_largest(batches, constants, springs, excess);
    Moves moves;
    find_moves(batches, constants, springs, relaxation, moves);
    move(batches, s, moves, group, positions);
  }
  return largest(excess);
}

// One square root for the longest and the shortest.
template <class Group>
[[gnu::always_inline]] inline double measure(const StretchBatches& batches, const StretchBatches::Part& part,
                                             const LengthRange& range, const double* positions) {
  SpringLanes longest{};
  SpringLanes shortest = SpringLanes{} + HUGE_VAL;
  for (Index s = part.begin; s < part.end; s += kSpringLanes) {
    Group group;
    Lengths springs;
    load(batches, s, positions, group, springs);
    SpringLanes per_length;
    load_lanes(&batches.per_length[part.same ? part.begin : s], per_length);
    const SpringLanes squared = springs.squared * (per_length * per_length);
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
  return part.run ? project<RunGroup>(batches, part, range, relaxation, positions)
                  : project<GatheredGroup>(batches, part, range, relaxation, positions);
}

SPRUNG_KERNEL
double measure_springs(const StretchBatches& batches, const StretchBatches::Part& part, const LengthRange& range,
                       const double* positions) {
  return part.run ? measure<RunGroup>(batches, part, range, positions) : measure<GatheredGroup>(batches, part, range, positions);
}

}  // namespace sprung
