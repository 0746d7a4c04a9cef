// Kernel access to springs between arbitrary particles. See layouts.h.
#pragma once

#include "dynamics/numerics/simd_packed.h"
#include "dynamics/stretch_limit/layouts.h"
#include "dynamics/stretch_limit/spring_batches.h"

#include <type_traits>

namespace sprung {

/// Four springs between arbitrary particles.
struct GatheredGroup {
  using Lanes = Double4;

  [[gnu::always_inline]] static void find_squared(const SpringBatches& batches, Index s, const double* positions, Lanes& squared) {
    Lanes squares[kSimdWidth];
    for (Index k = 0; k < kSimdWidth; ++k) {
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
  [[gnu::always_inline]] static void move(const SpringBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    Lanes first[kSimdWidth];
    Lanes second[kSimdWidth];
    for (Index k = 0; k < kSimdWidth; ++k) {
      load_one(positions + offset_of(batches.first[s + k]), first[k]);
      load_one(positions + offset_of(batches.second[s + k]), second[k]);
    }
    for (Index k = 0; k < kSimdWidth; ++k) {
      const Lanes between = second[k] - first[k];
      first[k] += pulls.first[k] * between;
      second[k] -= pulls.second[k] * between;
      if constexpr (!std::is_same_v<Pushes, NoPushes>) {
        Lanes between_before;
        find_between(batches, s + k, before, between_before);
        first[k] += pushes.first[k] * between_before;
        second[k] -= pushes.second[k] * between_before;
      }
      store_one(first[k], positions + offset_of(batches.first[s + k]));
      store_one(second[k], positions + offset_of(batches.second[s + k]));
    }
  }

 private:
  [[gnu::always_inline]] static void find_between(const SpringBatches& batches, Index s, const double* positions, Lanes& between) {
    Lanes first;
    load_one(positions + offset_of(batches.first[s]), first);
    load_one(positions + offset_of(batches.second[s]), between);
    between -= first;
  }

  using Pair = double __attribute__((vector_size(2 * sizeof(double))));
  using StoredPair = double __attribute__((vector_size(2 * sizeof(double)), aligned(alignof(double)), may_alias));

  // Loads four lanes, the last one 0: this takes fewer shuffles than gathering x, y and z of four particles.
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
