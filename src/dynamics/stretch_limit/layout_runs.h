// Kernel access to springs between two runs of particles. See layouts.h.
#pragma once

#include "dynamics/numerics/simd_packed.h"
#include "dynamics/stretch_limit/layouts.h"
#include "dynamics/stretch_limit/spring_batches.h"

#include <type_traits>

namespace sprung {

/// Springs between consecutive particles and other consecutive particles, as many as there are lanes.
template <class PackedVectors>
struct RunGroup {
  using Lanes = typename PackedVectors::Lanes;

  [[gnu::always_inline]] static void find_squared(const SpringBatches& batches, Index s, const double* positions, Lanes& squared) {
    PackedVectors between{};
    find_between(batches, s, positions, between);
    square(between);
    Lanes y, z;
    unpack(between, squared, y, z);
    squared = squared + y + z;
  }

  template <class Pushes>
  [[gnu::always_inline]] static void move(const SpringBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    double* const first_at = positions + offset_of(batches.first[s]);
    double* const second_at = positions + offset_of(batches.second[s]);
    PackedVectors first{};
    PackedVectors second{};
    load(first_at, first);
    load(second_at, second);
    PackedVectors between{};
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
  [[gnu::always_inline]] static void find_between(const SpringBatches& batches, Index s, const double* positions,
                                                  PackedVectors& between) {
    PackedVectors first{};
    load(positions + offset_of(batches.first[s]), first);
    load(positions + offset_of(batches.second[s]), between);
    subtract(between, first, between);
  }

  [[gnu::always_inline]] static void move_along(const PackedVectors& between, const Moves<Lanes>& moves, PackedVectors& first,
                                                PackedVectors& second) {
    PackedVectors of_first = between;
    PackedVectors of_second = between;
    multiply(of_first, moves.first);
    multiply(of_second, moves.second);
    add(first, of_first, first);
    subtract(second, of_second, second);
  }
};

}  // namespace sprung
