// Eight floats side by side: one instruction with AVX2, two without, the same bits with both.
#pragma once

namespace sprung {

inline constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

}  // namespace sprung
