// Springs between two runs of particles, as kernels read and write them at a time. See stretch_groups.h.
#pragma once

#include "dynamics/packed_lanes.h"
#include "dynamics/stretch_batches.h"
#include "dynamics/stretch_groups.h"

#include <type_traits>

namespace sprung {

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

}  // namespace sprung
