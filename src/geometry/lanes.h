// Four numbers or vectors side by side: one instruction with AVX2, two without, the same bits with both. For the .cpp files of
// kernels: functions that took these by value would have another ABI on each machine.
#pragma once

#include "base/types.h"

#include <bit>

namespace sprung {

inline constexpr int kLanes = 4;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LaneMask = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

/// Bit i is set where lane i of a comparison holds.
[[gnu::always_inline]] inline unsigned lanes_that_hold(const LaneMask& mask) {
  const LaneMask bits = mask & LaneMask{1, 2, 4, 8};
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
[[gnu::always_inline]] inline int take_smallest_lane(const Lanes& numbers, unsigned& lanes) {
  unsigned others = lanes;
  int smallest = take_lane(others);
  while (others != 0) {
    const int lane = take_lane(others);
    if (numbers[lane] < numbers[smallest]) smallest = lane;
  }
  lanes &= ~(1U << static_cast<unsigned>(smallest));
  return smallest;
}

struct LaneVector {
  Lanes x;
  Lanes y;
  Lanes z;
};

[[gnu::always_inline]] inline void set_lane(int lane, const Vector3& vector, LaneVector& to) {
  to.x[lane] = vector[0];
  to.y[lane] = vector[1];
  to.z[lane] = vector[2];
}

[[gnu::always_inline]] inline void set_all_lanes(const Vector3& vector, LaneVector& to) {
  to.x = Lanes{} + vector[0];
  to.y = Lanes{} + vector[1];
  to.z = Lanes{} + vector[2];
}

[[gnu::always_inline]] inline void subtract(const LaneVector& a, const LaneVector& b, LaneVector& to) {
  to.x = a.x - b.x;
  to.y = a.y - b.y;
  to.z = a.z - b.z;
}

/// In Eigen's order.
[[gnu::always_inline]] inline void dot(const LaneVector& a, const LaneVector& b, Lanes& to) {
  to = a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace sprung
