// Numbers side by side: one instruction with AVX2, two without, the same bits with both.
#pragma once

#include "geometry/lanes.h"

namespace sprung {

/// Children of a node.
inline constexpr int kTreeLanes = 8;
using TreeLanes = float __attribute__((vector_size(kTreeLanes * sizeof(float))));
using TreeMask = std::int32_t __attribute__((vector_size(kTreeLanes * sizeof(std::int32_t))));

/// Bit i is set where lane i of a comparison holds.
[[gnu::always_inline]] inline unsigned lanes_that_hold(const TreeMask& mask) {
  const TreeMask bits = mask & TreeMask{1, 2, 4, 8, 16, 32, 64, 128};
  const auto four = __builtin_shufflevector(bits, bits, 0, 1, 2, 3) | __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  const auto two = four | __builtin_shufflevector(four, four, 2, 3, 0, 1);
  return static_cast<unsigned>(two[0] | two[1]);
}

}  // namespace sprung
