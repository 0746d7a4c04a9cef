// Boxes in single precision, rounded outward: traversals of a mesh BVH compare them with its nodes.
#pragma once

#include "base/types.h"

#include <cmath>
#include <limits>

namespace sprung {

/// A float above or below the value, by one or two roundings; near 0 by the smallest normal float.
[[nodiscard]] inline float float_above(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest + (std::abs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
[[nodiscard]] inline float float_below(double value) { return -float_above(-value); }

struct FloatBox {
  float min[3];
  float max[3];
};

/// A box that contains `box`.
[[nodiscard]] inline FloatBox float_box(const Box3& box) {
  FloatBox rounded;
  for (int axis = 0; axis < 3; ++axis) {
    rounded.min[axis] = float_below(box.min()[axis]);
    rounded.max[axis] = float_above(box.max()[axis]);
  }
  return rounded;
}

}  // namespace sprung
