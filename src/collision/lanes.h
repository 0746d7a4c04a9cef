// Numbers side by side: one instruction with AVX2, two without, the same bits with both.
#pragma once

#include <bit>
#include <cstdint>

namespace sprung {

/// Children of a node.
inline constexpr int kTreeLanes = 8;
using TreeLanes = float __attribute__((vector_size(kTreeLanes * sizeof(float))));
using TreeMask = std::int32_t __attribute__((vector_size(kTreeLanes * sizeof(std::int32_t))));

/// Triangles of a block.
inline constexpr int kBlockLanes = 4;
using BlockLanes = double __attribute__((vector_size(kBlockLanes * sizeof(double))));
using BlockMask = std::int64_t __attribute__((vector_size(kBlockLanes * sizeof(std::int64_t))));

/// Bit i is set where lane i of a comparison holds.
[[gnu::always_inline]] inline unsigned lanes_that_hold(const TreeMask& mask) {
  const TreeMask bits = mask & TreeMask{1, 2, 4, 8, 16, 32, 64, 128};
  const auto four = __builtin_shufflevector(bits, bits, 0, 1, 2, 3) | __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  const auto two = four | __builtin_shufflevector(four, four, 2, 3, 0, 1);
  return static_cast<unsigned>(two[0] | two[1]);
}

[[gnu::always_inline]] inline unsigned lanes_that_hold(const BlockMask& mask) {
  const BlockMask bits = mask & BlockMask{1, 2, 4, 8};
  const auto two = __builtin_shufflevector(bits, bits, 0, 1) | __builtin_shufflevector(bits, bits, 2, 3);
  return static_cast<unsigned>(two[0] | two[1]);
}

/// Takes the lowest of the lanes out of the set, which must not be empty, and returns it.
[[gnu::always_inline]] inline int take_lane(unsigned& lanes) {
  const int lane = std::countr_zero(lanes);
  lanes &= lanes - 1;
  return lane;
}

/// The same for the lane with the smallest of the numbers.
[[gnu::always_inline]] inline int take_smallest_lane(const BlockLanes& numbers, unsigned& lanes) {
  unsigned others = lanes;
  int smallest = take_lane(others);
  while (others != 0) {
    const int lane = take_lane(others);
    if (numbers[lane] < numbers[smallest]) smallest = lane;
  }
  lanes &= ~(1U << static_cast<unsigned>(smallest));
  return smallest;
}

}  // namespace sprung
