// Eight floats side by side: one instruction with AVX2, two without, the same bits with both.
#pragma once

namespace sprung {

inline constexpr int kTreeLanes = 8;
using TreeLanes = float __attribute__((vector_size(kTreeLanes * sizeof(float))));

}  // namespace sprung
