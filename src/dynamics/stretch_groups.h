// Groups of springs as they lie in the layouts of StretchBatches: what kernels read and write of them at a time. Each layout has
// `find_squared`, the springs' squared lengths, and `move`, which moves their ends towards each other, or away along where they
// were before. For the .cpp files of kernels, as lanes.h.
#pragma once

#include "dynamics/packed_lanes.h"
#include "dynamics/stretch_batches.h"

#include <type_traits>

namespace sprung {

/// What ends move, as parts of the way to the other.
template <class Lanes>
struct Moves {
  Lanes first;
  Lanes second;
};

/// No moves along where springs were before.
struct NoPushes {};

[[gnu::always_inline]] inline std::ptrdiff_t place_of(Index particle) { return std::ptrdiff_t{3} * particle; }

/// Springs between consecutive particles and consecutive others.
template <class Packed>
struct RunGroup {
  using Lanes = typename Packed::Lanes;

  [[gnu::always_inline]] static void find_squared(const StretchBatches& batches, Index s, const double* positions, Lanes& squared) {
    Packed between;
    find_between(batches, s, positions, between);
    square(between);
    Lanes y, z;
    unpack(between, squared, y, z);
    squared = squared + y + z;
  }

  template <class Pushes>
  [[gnu::always_inline]] static void move(const StretchBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    double* const first_at = positions + place_of(batches.first[s]);
    double* const second_at = positions + place_of(batches.second[s]);
    Packed first;
    Packed second;
    load(first_at, first);
    load(second_at, second);
    Packed between;
    subtract(second, first, between);
    move_along(between, pulls, first, second);
    if constexpr (!std::is_same_v<Pushes, NoPushes>) {
      find_between(batches, s, before, between);
      move_along(between, pushes, first, second);
    }
    store(first, first_at);
    store(second, second_at);
  }

 private:
  [[gnu::always_inline]] static void find_between(const StretchBatches& batches, Index s, const double* positions,
                                                  Packed& between) {
    Packed first;
    load(positions + place_of(batches.first[s]), first);
    load(positions + place_of(batches.second[s]), between);
    subtract(between, first, between);
  }

  [[gnu::always_inline]] static void move_along(const Packed& between, const Moves<Lanes>& moves, Packed& first, Packed& second) {
    Packed of_first = between;
    Packed of_second = between;
    multiply(of_first, moves.first);
    multiply(of_second, moves.second);
    add(first, of_first, first);
    subtract(second, of_second, second);
  }
};

/// Springs that join consecutive particles two by two, half of them those of some, half those of others: see
/// StretchBatches::Layout.
template <class Packed>
struct PairGroup {
  using Lanes = typename Packed::Lanes;

  [[gnu::always_inline]] static void find_squared(const StretchBatches& batches, Index s, const double* positions, Lanes& squared) {
    Lanes of_others;
    find_squared_of_half(positions + place_of(batches.first[s]), squared);
    find_squared_of_half(positions + place_of(start_of_others(batches, s)), of_others);
    merge(of_others, squared);
  }

  template <class Pushes>
  [[gnu::always_inline]] static void move(const StretchBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    const std::ptrdiff_t some_at = place_of(batches.first[s]);
    const std::ptrdiff_t others_at = place_of(start_of_others(batches, s));
    Packed parts;
    Packed of_others;
    Packed some;
    Packed others;
    spread(pulls, parts, of_others);
    load(positions + some_at, some);
    load(positions + others_at, others);
    Packed some_now = some;
    Packed others_now = others;
    move_half(parts, some_now, some);
    move_half(of_others, others_now, others);
    if constexpr (!std::is_same_v<Pushes, NoPushes>) {
      spread(pushes, parts, of_others);
      load(before + some_at, some_now);
      load(before + others_at, others_now);
      move_half(parts, some_now, some);
      move_half(of_others, others_now, others);
    }
    store(some, positions + some_at);
    store(others, positions + others_at);
  }

 private:
  [[gnu::always_inline]] static Index start_of_others(const StretchBatches& batches, Index s) {
    return kCountOf<Lanes> == kWideLanes ? batches.first[s + kSpringLanes] : batches.first[s] + kSpringLanes;
  }

  // Of all neighbours; those of every other two are no springs.
  [[gnu::always_inline]] static void find_squared_of_half(const double* positions, Lanes& squared) {
    Packed particles;
    Packed between;
    load(positions, particles);
    load_next(positions, particles, between);
    subtract(between, particles, between);
    square(between);
    Lanes y, z;
    unpack(between, squared, y, z);
    squared = squared + y + z;
  }

  [[gnu::always_inline]] static void merge(const SpringLanes& others, SpringLanes& squared) {
    squared = __builtin_shufflevector(squared, others, 0, 4, 2, 6);
  }
  [[gnu::always_inline]] static void merge(const WideLanes& others, WideLanes& squared) {
    squared = __builtin_shufflevector(squared, others, 0, 4, 2, 6, 8, 12, 10, 14);
  }

  // By parts of the way to their neighbours `there`.
  [[gnu::always_inline]] static void move_half(const Packed& parts, const Packed& there, Packed& particles) {
    Packed to_others;
    swap_neighbours(there, to_others);
    subtract(to_others, there, to_others);
    particles.low += parts.low * to_others.low;
    particles.middle += parts.middle * to_others.middle;
    particles.high += parts.high * to_others.high;
  }

  // Each particle's own.
  [[gnu::always_inline]] static void spread(const Moves<SpringLanes>& moves, Packed& parts, Packed& others) {
    parts.low = __builtin_shufflevector(moves.first, moves.second, 0, 0, 0, 4);
    parts.middle = __builtin_shufflevector(moves.first, moves.second, 4, 4, 2, 2);
    parts.high = __builtin_shufflevector(moves.first, moves.second, 2, 6, 6, 6);
    others.low = __builtin_shufflevector(moves.first, moves.second, 1, 1, 1, 5);
    others.middle = __builtin_shufflevector(moves.first, moves.second, 5, 5, 3, 3);
    others.high = __builtin_shufflevector(moves.first, moves.second, 3, 7, 7, 7);
  }
  [[gnu::always_inline]] static void spread(const Moves<WideLanes>& moves, Packed& parts, Packed& others) {
    parts.low = __builtin_shufflevector(moves.first, moves.second, 0, 0, 0, 8, 8, 8, 2, 2);
    parts.middle = __builtin_shufflevector(moves.first, moves.second, 2, 10, 10, 10, 1, 1, 1, 9);
    parts.high = __builtin_shufflevector(moves.first, moves.second, 9, 9, 3, 3, 3, 11, 11, 11);
    others.low = __builtin_shufflevector(moves.first, moves.second, 4, 4, 4, 12, 12, 12, 6, 6);
    others.middle = __builtin_shufflevector(moves.first, moves.second, 6, 14, 14, 14, 5, 5, 5, 13);
    others.high = __builtin_shufflevector(moves.first, moves.second, 13, 13, 7, 7, 7, 15, 15, 15);
  }
};

/// Four springs between any particles.
struct GatheredGroup {
  using Lanes = SpringLanes;

  [[gnu::always_inline]] static void find_squared(const StretchBatches& batches, Index s, const double* positions, Lanes& squared) {
    Lanes squares[kSpringLanes];
    for (Index k = 0; k < kSpringLanes; ++k) {
      Lanes between;
      find_between(batches, s + k, positions, between);
      squares[k] = between * between;
    }
    const Lanes sums01 =
        __builtin_shufflevector(squares[0], squares[1], 0, 4, 2, 6) + __builtin_shufflevector(squares[0], squares[1], 1, 5, 3, 7);
    const Lanes sums23 =
        __builtin_shufflevector(squares[2], squares[3], 0, 4, 2, 6) + __builtin_shufflevector(squares[2], squares[3], 1, 5, 3, 7);
    squared = __builtin_shufflevector(sums01, sums23, 0, 1, 4, 5) + __builtin_shufflevector(sums01, sums23, 2, 3, 6, 7);
  }

  template <class Pushes>
  [[gnu::always_inline]] static void move(const StretchBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    Lanes first[kSpringLanes];
    Lanes second[kSpringLanes];
    for (Index k = 0; k < kSpringLanes; ++k) {
      load_one(positions + place_of(batches.first[s + k]), first[k]);
      load_one(positions + place_of(batches.second[s + k]), second[k]);
    }
    for (Index k = 0; k < kSpringLanes; ++k) {
      const Lanes between = second[k] - first[k];
      first[k] += pulls.first[k] * between;
      second[k] -= pulls.second[k] * between;
      if constexpr (!std::is_same_v<Pushes, NoPushes>) {
        Lanes between_before;
        find_between(batches, s + k, before, between_before);
        first[k] += pushes.first[k] * between_before;
        second[k] -= pushes.second[k] * between_before;
      }
      store_one(first[k], positions + place_of(batches.first[s + k]));
      store_one(second[k], positions + place_of(batches.second[s + k]));
    }
  }

 private:
  [[gnu::always_inline]] static void find_between(const StretchBatches& batches, Index s, const double* positions, Lanes& between) {
    Lanes first;
    load_one(positions + place_of(batches.first[s]), first);
    load_one(positions + place_of(batches.second[s]), between);
    between -= first;
  }

  using Pair = double __attribute__((vector_size(2 * sizeof(double))));
  using StoredPair = double __attribute__((vector_size(2 * sizeof(double)), aligned(alignof(double)), may_alias));

  // Four lanes, the last one 0: fewer shuffles than gathering x, y and z of four particles.
  [[gnu::always_inline]] static void load_one(const double* from, Lanes& to) {
    const Pair xy = *reinterpret_cast<const StoredPair*>(from);
    const Pair z{from[2], 0.0};
    to = __builtin_shufflevector(xy, z, 0, 1, 2, 3);
  }
  [[gnu::always_inline]] static void store_one(const Lanes& from, double* to) {
    *reinterpret_cast<StoredPair*>(to) = __builtin_shufflevector(from, from, 0, 1);
    to[2] = from[2];
  }
};

}  // namespace sprung
