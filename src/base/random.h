// Random numbers that are a function of a seed and a counter, so that they do not depend on an order or on threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace sprung {

/// All bits depend on all bits (the finalizer of SplitMix64, Steele et al. 2014).
[[nodiscard]] inline std::uint64_t mixed_bits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31U);
}

/// In [0, 1), uniform (SplitMix64).
[[nodiscard]] inline double random_number(std::uint64_t seed, std::uint64_t counter) {
  const std::uint64_t mixed = mixed_bits(seed + (counter + 1) * 0x9e3779b97f4a7c15U);
  return std::ldexp(static_cast<double>(mixed >> 11U), -std::numeric_limits<double>::digits);
}

}  // namespace sprung
