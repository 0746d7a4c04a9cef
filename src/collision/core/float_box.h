// Boxes of single precision, rounded outward: what walks through a mesh's tree compare with its nodes.
#pragma once

#include "base/types.h"

#include <cmath>
#include <limits>

namespace sprung {

/// A float somewhat above or below: by a rounding or two, also where floats are hardly more than nothing.
[[nodiscard]] inline float float_above(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest + (std::abs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
[[nodiscard]] inline float float_below(double value) { return -float_above(-value); }

struct FloatBox {
  float min[3];
  float max[3];
};

/// Holds the box.
[[nodiscard]] inline FloatBox float_box(const Box3& box) {
  FloatBox rounded;
  for (int axis = 0; axis < 3; ++axis) {
    rounded.min[axis] = float_below(box.min()[axis]);
    rounded.max[axis] = float_above(box.max()[axis]);
  }
  return rounded;
}

}  // namespace sprung
