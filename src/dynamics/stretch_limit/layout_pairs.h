// Kernel access to springs within runs of particles. See layouts.h.
#pragma once

#include "dynamics/numerics/simd_packed.h"
#include "dynamics/stretch_limit/layouts.h"
#include "dynamics/stretch_limit/spring_batches.h"

#include <type_traits>

namespace sprung {

/// Springs that join consecutive particles two by two, half of them from one register and half from the next: see
/// SpringBatches::Layout.
template <class PackedVectors4>
struct PairGroup {
  using Lanes = typename PackedVectors4::Lanes;

  [[gnu::always_inline]] static void find_squared(const SpringBatches& batches, Index s, const double* positions, Lanes& squared) {
    Lanes of_others;
    find_squared_of_half(positions + offset_of(batches.first[s]), squared);
    find_squared_of_half(positions + offset_of(start_of_others(batches, s)), of_others);
    merge(of_others, squared);
  }

  template <class Pushes>
  [[gnu::always_inline]] static void move(const SpringBatches& batches, Index s, const Moves<Lanes>& pulls, const Pushes& pushes,
                                          const double* before, double* positions) {
    const std::ptrdiff_t some_at = offset_of(batches.first[s]);
    const std::ptrdiff_t others_at = offset_of(start_of_others(batches, s));
    PackedVectors4 fractions;
    PackedVectors4 of_others;
    PackedVectors4 some;
    PackedVectors4 others;
    spread(pulls, fractions, of_others);
    load(positions + some_at, some);
    load(positions + others_at, others);
    PackedVectors4 some_now = some;
    PackedVectors4 others_now = others;
    move_half(fractions, some_now, some);
    move_half(of_others, others_now, others);
    if constexpr (!std::is_same_v<Pushes, NoPushes>) {
      spread(pushes, fractions, of_others);
      load(before + some_at, some_now);
      load(before + others_at, others_now);
      move_half(fractions, some_now, some);
      move_half(of_others, others_now, others);
    }
    store(some, positions + some_at);
    store(others, positions + others_at);
  }

 private:
  [[gnu::always_inline]] static Index start_of_others(const SpringBatches& batches, Index s) {
    return kCountOf<Lanes> == kWideSimdWidth ? batches.first[s + kSimdWidth] : batches.first[s] + kSimdWidth;
  }

  // Squared distances of all neighbours; every other one is no spring.
  [[gnu::always_inline]] static void find_squared_of_half(const double* positions, Lanes& squared) {
    PackedVectors4 particles;
    PackedVectors4 between;
    load(positions, particles);
    load_next(positions, particles, between);
    subtract(between, particles, between);
    square(between);
    Lanes y, z;
    unpack(between, squared, y, z);
    squared = squared + y + z;
  }

  [[gnu::always_inline]] static void merge(const Double4& others, Double4& squared) {
    squared = __builtin_shufflevector(squared, others, 0, 4, 2, 6);
  }
  [[gnu::always_inline]] static void merge(const Double8& others, Double8& squared) {
    squared = __builtin_shufflevector(squared, others, 0, 4, 2, 6, 8, 12, 10, 14);
  }

  // Moves by fractions of the vectors to the neighbours `there`.
  [[gnu::always_inline]] static void move_half(const PackedVectors4& fractions, const PackedVectors4& there,
                                               PackedVectors4& particles) {
    PackedVectors4 to_others;
    swap_neighbours(there, to_others);
    subtract(to_others, there, to_others);
    particles.low += fractions.low * to_others.low;
    particles.middle += fractions.middle * to_others.middle;
    particles.high += fractions.high * to_others.high;
  }

  // Gives each particle its own fraction.
  [[gnu::always_inline]] static void spread(const Moves<Double4>& moves, PackedVectors4& fractions, PackedVectors4& others) {
    fractions.low = __builtin_shufflevector(moves.first, moves.second, 0, 0, 0, 4);
    fractions.middle = __builtin_shufflevector(moves.first, moves.second, 4, 4, 2, 2);
    fractions.high = __builtin_shufflevector(moves.first, moves.second, 2, 6, 6, 6);
    others.low = __builtin_shufflevector(moves.first, moves.second, 1, 1, 1, 5);
    others.middle = __builtin_shufflevector(moves.first, moves.second, 5, 5, 3, 3);
    others.high = __builtin_shufflevector(moves.first, moves.second, 3, 7, 7, 7);
  }
  [[gnu::always_inline]] static void spread(const Moves<Double8>& moves, PackedVectors4& fractions, PackedVectors4& others) {
    fractions.low = __builtin_shufflevector(moves.first, moves.second, 0, 0, 0, 8, 8, 8, 2, 2);
    fractions.middle = __builtin_shufflevector(moves.first, moves.second, 2, 10, 10, 10, 1, 1, 1, 9);
    fractions.high = __builtin_shufflevector(moves.first, moves.second, 9, 9, 3, 3, 3, 11, 11, 11);
    others.low = __builtin_shufflevector(moves.first, moves.second, 4, 4, 4, 12, 12, 12, 6, 6);
    others.middle = __builtin_shufflevector(moves.first, moves.second, 6, 14, 14, 14, 5, 5, 5, 13);
    others.high = __builtin_shufflevector(moves.first, moves.second, 13, 13, 7, 7, 7, 15, 15, 15);
  }
};

}  // namespace sprung
