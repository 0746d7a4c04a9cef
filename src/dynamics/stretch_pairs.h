// Springs within runs of particles, as kernels read and write them at a time. See stretch_groups.h.
#pragma once

#include "dynamics/packed_lanes.h"
#include "dynamics/stretch_batches.h"
#include "dynamics/stretch_groups.h"

#include <type_traits>

namespace sprung {

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

}  // namespace sprung
