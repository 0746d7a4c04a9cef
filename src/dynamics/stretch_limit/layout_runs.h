// Kernel access to springs between two runs of particles. See layouts.h.
#pragma once

#include "dynamics/numerics/simd_packed.h"
#include "dynamics/stretch_limit/layouts.h"
#include "dynamics/stretch_limit/spring_batches.h"

#include <type_traits>

namespace sprung {

/// Springs between consecutive particles and other consecutive particles: as many as there are lanes, or two or three in four
/// lanes.
template <class PackedVectors4, Index kSprings = kCountOf<typename PackedVectors4::Lanes>>
struct RunGroup {
  using Lanes = typename PackedVectors4::Lanes;

  [[gnu::always_inline]] static void find_squared(const SpringBatches& batches, Index s, const double* positions, Lanes& squared) {
    PackedVectors4 between{};
    find_between(batches, s, positions, between);
    square(between);
    Lanes y, z;
    unpack(between, squared, y, z);
    squared = squared + y + z;
    if constexpr (kSprings == 3) squared = __builtin_shufflevector(squared, squared, 0, 1, 2, 2);
    if constexpr (kSprings == 2) squared = __builtin_shufflevector(squared, squared, 0, 1, 1, 1);
  }

  template <class Pushes>
  [[gnu::always_inline]] static void move(const SpringBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    double* const first_at = positions + offset_of(batches.first[s]);
    double* const second_at = positions + offset_of(batches.second[s]);
    PackedVectors4 first{};
    PackedVectors4 second{};
    load_run(first_at, first);
    load_run(second_at, second);
    PackedVectors4 between{};
    subtract(second, first, between);
    move_along(between, pulls, first, second);
    if constexpr (!std::is_same_v<Pushes, NoPushes>) {
      find_between(batches, s, before, between);
      move_along(between, pushes, first, second);
    }
    store_run(first, first_at);
    store_run(second, second_at);
  }

 private:
  static constexpr bool kIsFull = kSprings == kCountOf<Lanes>;

  // Touches no particle behind the run: another thread may write to it, and it may not exist.
  [[gnu::always_inline]] static void load_run(const double* from, PackedVectors4& to) {
    if constexpr (kIsFull) {
      load(from, to);
    } else {
      static_assert(kCountOf<Lanes> == kSimdWidth && (kSprings == 2 || kSprings == 3));
      load_simd(from, to.low);
      to.middle = Lanes{from[4], from[5], kSprings == 3 ? from[6] : 0.0, kSprings == 3 ? from[7] : 0.0};
      to.high = Lanes{kSprings == 3 ? from[8] : 0.0};
    }
  }

  [[gnu::always_inline]] static void store_run(const PackedVectors4& from, double* to) {
    if constexpr (kIsFull) {
      store(from, to);
    } else {
      store_simd(from.low, to);
      to[4] = from.middle[0];
      to[5] = from.middle[1];
      if constexpr (kSprings == 3) {
        to[6] = from.middle[2];
        to[7] = from.middle[3];
        to[8] = from.high[0];
      }
    }
  }

  [[gnu::always_inline]] static void find_between(const SpringBatches& batches, Index s, const double* positions,
                                                  PackedVectors4& between) {
    PackedVectors4 first{};
    load_run(positions + offset_of(batches.first[s]), first);
    load_run(positions + offset_of(batches.second[s]), between);
    subtract(between, first, between);
  }

  [[gnu::always_inline]] static void move_along(const PackedVectors4& between, const Moves<Lanes>& moves, PackedVectors4& first,
                                                PackedVectors4& second) {
    PackedVectors4 of_first = between;
    PackedVectors4 of_second = between;
    multiply(of_first, moves.first);
    multiply(of_second, moves.second);
    add(first, of_first, first);
    subtract(second, of_second, second);
  }
};

}  // namespace sprung
