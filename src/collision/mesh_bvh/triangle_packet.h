// Up to four triangles in SIMD lanes: the leaves of a mesh BVH.
#pragma once

#include "base/machine/simd.h"
#include "base/types.h"

#include <array>

namespace sprung {

struct alignas(64) TrianglePacket {
  Double4 corner[3][3];        ///< [m]: corner k along axis a, one lane per triangle; lanes beyond `count` repeat the last triangle
  Index triangle[kSimdWidth];  ///< numbers in the mesh
  std::int32_t count;          ///< 1 to kSimdWidth

  [[nodiscard]] std::array<Vector3, 3> corners(int lane) const { return {position(lane, 0), position(lane, 1), position(lane, 2)}; }
  /// Bit i is set for each lane i with a triangle.
  [[nodiscard]] unsigned lanes() const { return (1U << static_cast<unsigned>(count)) - 1U; }

 private:
  [[nodiscard]] Vector3 position(int lane, int k) const { return {corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]}; }
};

/// The triangles whose own box intersects or touches `box` [m]: bit i stands for lane i.
[[gnu::always_inline]] inline unsigned triangles_in_box(const TrianglePacket& block, const Box3& box) {
  Mask4 outside{};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis];
    const double high = box.max()[axis];
    const Double4& a = block.corner[0][axis];
    const Double4& b = block.corner[1][axis];
    const Double4& c = block.corner[2][axis];
    outside |= (a < low) & (b < low) & (c < low);
    outside |= (a > high) & (b > high) & (c > high);
  }
  return block.lanes() & ~mask_bits(outside);
}

/// The triangles with a corner above the plane normal . x = limit.
[[gnu::always_inline]] inline unsigned triangles_above(const TrianglePacket& block, const Vector3& normal, double limit) {
  Mask4 above{};
  for (const auto& x : block.corner) above |= x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2] > limit;
  return block.lanes() & mask_bits(above);
}

/// Squared distances [m^2] of the triangles' own boxes from `box`.
[[gnu::always_inline]] inline void squared_box_distances(const TrianglePacket& block, const Box3& box, Double4& squared) {
  squared = Double4{};
  for (int axis = 0; axis < 3; ++axis) {
    const Double4& a = block.corner[0][axis];
    const Double4& b = block.corner[1][axis];
    const Double4& c = block.corner[2][axis];
    const Double4 low = a < b ? (a < c ? a : c) : (b < c ? b : c);
    const Double4 high = a > b ? (a > c ? a : c) : (b > c ? b : c);
    const Double4 before = low - box.max()[axis];
    const Double4 behind = box.min()[axis] - high;
    const Double4 farther = before > behind ? before : behind;
    const Double4 outside = farther > 0.0 ? farther : Double4{};
    squared += outside * outside;
  }
}

}  // namespace sprung
