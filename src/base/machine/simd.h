// Vectors of numbers for hot loops: double x 4, double x 8 and float x 8. The compiler maps them to the registers of the machine;
// the bits are the same on every machine. For the .cpp files of kernels alone: functions that pass these types by value would have
// another ABI on each machine.
#pragma once

#include "base/types.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace sprung {

inline constexpr Index kSimdWidth = 4;       ///< number of doubles that most kernels compute at a time
inline constexpr Index kWideSimdWidth = 8;   ///< number of doubles in kernels with a version for AVX-512
inline constexpr Index kFloatSimdWidth = 8;  ///< number of floats: the children of a wide BVH node

/// `kCount` numbers of one type: in registers (Type), and unaligned in memory (Stored).
template <class Number, Index kCount>
struct SimdOf {
  typedef Number Type __attribute__((vector_size(kCount * sizeof(Number))));
  typedef Number Stored __attribute__((vector_size(kCount * sizeof(Number)), aligned(alignof(Number)), may_alias));
};
using Double4 = SimdOf<double, kSimdWidth>::Type;
using Double8 = SimdOf<double, kWideSimdWidth>::Type;
using Float8 = SimdOf<float, kFloatSimdWidth>::Type;

/// Masks: results of comparisons.
using Mask4 = std::int64_t __attribute__((vector_size(kSimdWidth * sizeof(std::int64_t))));
using FloatMask8 = std::int32_t __attribute__((vector_size(kFloatSimdWidth * sizeof(std::int32_t))));

/// The integer type with the same number of bits.
template <class Lanes>
struct BitsOf;
template <>
struct BitsOf<Double4> {
  using Type = std::int64_t __attribute__((vector_size(sizeof(Double4))));
};
template <>
struct BitsOf<Double8> {
  using Type = std::int64_t __attribute__((vector_size(sizeof(Double8))));
};

template <class Lanes>
using NumberOf = std::remove_cvref_t<decltype(std::declval<Lanes>()[0])>;

template <class Lanes>
inline constexpr Index kCountOf = sizeof(Lanes) / sizeof(NumberOf<Lanes>);

/// The unaligned type in memory.
template <class Lanes>
using StoredSimd = typename SimdOf<NumberOf<Lanes>, kCountOf<Lanes>>::Stored;

template <class Lanes>
[[gnu::always_inline]] inline void load_simd(const NumberOf<Lanes>* from, Lanes& to) {
  to = *reinterpret_cast<const StoredSimd<Lanes>*>(from);
}
template <class Lanes>
[[gnu::always_inline]] inline void store_simd(const Lanes& from, NumberOf<Lanes>* to) {
  *reinterpret_cast<StoredSimd<Lanes>*>(to) = from;
}

[[gnu::always_inline]] inline void square_root(Double4& of) {
  for (Index lane = 0; lane < kSimdWidth; ++lane) of[lane] = std::sqrt(of[lane]);
}

[[gnu::always_inline]] inline bool any_above(const Double4& of, const Double4& limits) {
  const auto above = of > limits;
  return (above[0] | above[1] | above[2] | above[3]) != 0;
}

[[gnu::always_inline]] inline bool any_above(const Double8& of, const Double8& limits) {
  const auto above = of > limits;
  const auto some = __builtin_shufflevector(above, above, 0, 1, 2, 3) | __builtin_shufflevector(above, above, 4, 5, 6, 7);
  return (some[0] | some[1] | some[2] | some[3]) != 0;
}

/// Approximates 1 / sqrt(of) up to its last bit; a large finite number where `of` is 0. The steps are a first guess from the bits
/// (error 3.5 %), a cubic polynomial fitted to the remaining factor (7.5e-7), and one Halley step. This is faster than the square
/// root and division of the hardware, whose own estimates differ between makers.
template <class Lanes>
[[gnu::always_inline]] inline void inverse_root(const Lanes& of, Lanes& root) {
  using Bits = typename BitsOf<Lanes>::Type;
  root = reinterpret_cast<Lanes>(0x5fe6eb50c7b537a9 - (reinterpret_cast<Bits>(of) >> 1));
  Lanes left = 1.0 - (of * root) * root;
  root *= 0.999999254 + left * (0.500000423 + left * (0.37627901 + left * 0.313054059));
  left = 1.0 - (of * root) * root;
  root += root * (left * (0.5 + 0.375 * left));
}

/// Bit i is set where lane i of a comparison is true.
[[gnu::always_inline]] inline unsigned mask_bits(const Mask4& mask) {
  const Mask4 bits = mask & Mask4{1, 2, 4, 8};
  const auto two = __builtin_shufflevector(bits, bits, 0, 1) | __builtin_shufflevector(bits, bits, 2, 3);
  return static_cast<unsigned>(two[0] | two[1]);
}

[[gnu::always_inline]] inline unsigned mask_bits(const FloatMask8& mask) {
  const FloatMask8 bits = mask & FloatMask8{1, 2, 4, 8, 16, 32, 64, 128};
  const auto four = __builtin_shufflevector(bits, bits, 0, 1, 2, 3) | __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  const auto two = four | __builtin_shufflevector(four, four, 2, 3, 0, 1);
  return static_cast<unsigned>(two[0] | two[1]);
}

/// Removes the lowest lane from a non-empty set and returns it.
[[gnu::always_inline]] inline int pop_lane(unsigned& lanes) {
  const int lane = std::countr_zero(lanes);
  lanes &= lanes - 1;
  return lane;
}

/// Removes the lane with the smallest number from a non-empty set and returns it.
[[gnu::always_inline]] inline int pop_smallest_lane(const Double4& numbers, unsigned& lanes) {
  unsigned others = lanes;
  int smallest = pop_lane(others);
  while (others != 0) {
    const int lane = pop_lane(others);
    if (numbers[lane] < numbers[smallest]) smallest = lane;
  }
  lanes &= ~(1U << static_cast<unsigned>(smallest));
  return smallest;
}

struct Vector3x4 {
  Double4 x;
  Double4 y;
  Double4 z;
};

[[gnu::always_inline]] inline void set_lane(int lane, const Vector3& vector, Vector3x4& to) {
  to.x[lane] = vector[0];
  to.y[lane] = vector[1];
  to.z[lane] = vector[2];
}

[[gnu::always_inline]] inline void set_all_lanes(const Vector3& vector, Vector3x4& to) {
  to.x = Double4{} + vector[0];
  to.y = Double4{} + vector[1];
  to.z = Double4{} + vector[2];
}

[[gnu::always_inline]] inline void subtract(const Vector3x4& a, const Vector3x4& b, Vector3x4& to) {
  to.x = a.x - b.x;
  to.y = a.y - b.y;
  to.z = a.z - b.z;
}

/// Adds in the order in which Eigen does.
[[gnu::always_inline]] inline void dot(const Vector3x4& a, const Vector3x4& b, Double4& to) {
  to = a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace sprung
