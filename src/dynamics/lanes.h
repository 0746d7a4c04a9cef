// Four numbers at a time, in whatever registers the machine has, or eight where it has registers for as many. For the .cpp files of
// kernels: functions that take these by value would have another ABI on each machine.
#pragma once

#include "dynamics/lane_count.h"

#include <cmath>
#include <type_traits>
#include <utility>

namespace sprung {

/// So many numbers of one kind.
template <class Number, Index kCount>
struct LanesOf {
  typedef Number Type __attribute__((vector_size(kCount * sizeof(Number))));
  typedef Number Stored __attribute__((vector_size(kCount * sizeof(Number)), aligned(alignof(Number)), may_alias));
};
using SpringLanes = LanesOf<double, kSpringLanes>::Type;
using WideLanes = LanesOf<double, kWideLanes>::Type;

/// The bits of as many numbers.
template <class Lanes>
struct BitsOf;
template <>
struct BitsOf<SpringLanes> {
  using Type = std::int64_t __attribute__((vector_size(sizeof(SpringLanes))));
};
template <>
struct BitsOf<WideLanes> {
  using Type = std::int64_t __attribute__((vector_size(sizeof(WideLanes))));
};

template <class Lanes>
using NumberOf = std::remove_cvref_t<decltype(std::declval<Lanes>()[0])>;

template <class Lanes>
inline constexpr Index kCountOf = sizeof(Lanes) / sizeof(NumberOf<Lanes>);

/// The same wherever they lie in memory.
template <class Lanes>
using StoredLanes = typename LanesOf<NumberOf<Lanes>, kCountOf<Lanes>>::Stored;

template <class Lanes>
[[gnu::always_inline]] inline void load_lanes(const NumberOf<Lanes>* from, Lanes& to) {
  to = *reinterpret_cast<const StoredLanes<Lanes>*>(from);
}
template <class Lanes>
[[gnu::always_inline]] inline void store_lanes(const Lanes& from, NumberOf<Lanes>* to) {
  *reinterpret_cast<StoredLanes<Lanes>*>(to) = from;
}

[[gnu::always_inline]] inline void square_root(SpringLanes& of) {
  for (Index lane = 0; lane < kSpringLanes; ++lane) of[lane] = std::sqrt(of[lane]);
}

[[gnu::always_inline]] inline bool any_above(const SpringLanes& of, const SpringLanes& limits) {
  const auto above = of > limits;
  return (above[0] | above[1] | above[2] | above[3]) != 0;
}

[[gnu::always_inline]] inline bool any_above(const WideLanes& of, const WideLanes& limits) {
  const auto above = of > limits;
  const auto some = __builtin_shufflevector(above, above, 0, 1, 2, 3) | __builtin_shufflevector(above, above, 4, 5, 6, 7);
  return (some[0] | some[1] | some[2] | some[3]) != 0;
}

/// 1 / sqrt(of) but for its last bit, and some large number where `of` is 0. A first guess from the bits, good to 3.5 %; a cubic
/// that is best on what that leaves, good to 7.5e-7; and a step of Halley's. Machines' own square roots and quotients take longer,
/// one after the other, and their own guesses differ from maker to maker.
template <class Lanes>
[[gnu::always_inline]] inline void inverse_root(const Lanes& of, Lanes& root) {
  using Bits = typename BitsOf<Lanes>::Type;
  root = reinterpret_cast<Lanes>(0x5fe6eb50c7b537a9 - (reinterpret_cast<Bits>(of) >> 1));
  Lanes left = 1.0 - (of * root) * root;
  root *= 0.999999254 + left * (0.500000423 + left * (0.37627901 + left * 0.313054059));
  left = 1.0 - (of * root) * root;
  root += root * (left * (0.5 + 0.375 * left));
}

}  // namespace sprung
