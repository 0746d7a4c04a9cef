#include "collision/core/sphere_set.h"

#include "base/machine/kernel.h"

#include <algorithm>
#include <array>

namespace sprung {

namespace {

/// Bit i is set unless p is inside the sphere of lane i, at least `margin` below its surface.
[[gnu::always_inline]] inline unsigned lanes_outside(const Vector3x4& centre, const Double4& radius, double margin,
                                                     const Vector3x4& p) {
  const Double4 x = p.x - centre.x;
  const Double4 y = p.y - centre.y;
  const Double4 z = p.z - centre.z;
  const Double4 free = radius - margin;
  const Mask4 inside = (free > 0.0) & (x * x + y * y + z * z < free * free);
  return ~mask_bits(inside) & ((1U << static_cast<unsigned>(kSimdWidth)) - 1U);
}

[[gnu::always_inline]] inline void transform(const RigidTransform& into, Vector3x4& p) {
  const auto& m = into.matrix();
  const Double4 x = p.x;
  const Double4 y = p.y;
  const Double4 z = p.z;
  p.x = m(0, 0) * x + m(0, 1) * y + m(0, 2) * z + m(0, 3);
  p.y = m(1, 0) * x + m(1, 1) * y + m(1, 2) * z + m(1, 3);
  p.z = m(2, 0) * x + m(2, 1) * y + m(2, 2) * z + m(2, 3);
}

}  // namespace

void SphereSet::set(Index sphere, const Vector3& centre, double radius) {
  Block& block = blocks_[static_cast<std::size_t>(sphere) / kSimdWidth];
  set_lane(lane(sphere), centre, block.centre);
  block.radius[lane(sphere)] = radius;
}

SPRUNG_KERNEL void SphereSet::find_outside(const SphereVertices& asked, double margin, std::vector<Index>& outside) const {
  outside.clear();
  const auto count = static_cast<Index>(asked.particles.size());
  const double* positions = asked.positions.data();
  for (Index first = 0; first < count; first += kSimdWidth) {
    const auto position = [&](int lane) {
      const auto slot = static_cast<std::size_t>(std::min(first + lane, count - 1));
      return positions + 3 * static_cast<std::ptrdiff_t>(asked.particles[slot]);
    };
    const std::array<const double*, kSimdWidth> q{position(0), position(1), position(2), position(3)};
    Vector3x4 p{{q[0][0], q[1][0], q[2][0], q[3][0]}, {q[0][1], q[1][1], q[2][1], q[3][1]}, {q[0][2], q[1][2], q[2][2], q[3][2]}};
    transform(asked.into, p);
    unsigned lanes = lanes_outside(block(first).centre, block(first).radius, margin, p);
    while (lanes != 0) {
      const Index sphere = first + pop_lane(lanes);
      if (sphere < count) outside.push_back(sphere);
    }
  }
}

}  // namespace sprung
