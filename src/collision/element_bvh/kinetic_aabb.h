// Kinetic AABB: axis-aligned bounds that move linearly in time, in single precision.
#pragma once

namespace sprung {

/// At time t the bounds are min + t slowest and max + t fastest. Lanes are x, y, z and one that is always 0.
struct KineticAabb {
  using Axes = float __attribute__((vector_size(4 * sizeof(float))));

  Axes min{};
  Axes max{};
  Axes slowest{};
  Axes fastest{};
};

inline void extend(KineticAabb& bounds, const KineticAabb& other) {
  bounds.min = other.min < bounds.min ? other.min : bounds.min;
  bounds.max = other.max > bounds.max ? other.max : bounds.max;
  bounds.slowest = other.slowest < bounds.slowest ? other.slowest : bounds.slowest;
  bounds.fastest = other.fastest > bounds.fastest ? other.fastest : bounds.fastest;
}

/// Whether some axis keeps more than `margin` >= 0 between the bounds from `now` to `end`. The gap is linear in time, so checking
/// both times is enough.
[[nodiscard]] inline bool are_apart(const KineticAabb& a, const KineticAabb& b, float now, float end, float margin) {
  const KineticAabb::Axes above = a.min - b.max;
  const KineticAabb::Axes rising = a.slowest - b.fastest;
  const KineticAabb::Axes below = b.min - a.max;
  const KineticAabb::Axes falling = b.slowest - a.fastest;
  const auto apart = ((above + now * rising > margin) & (above + end * rising > margin)) |
                     ((below + now * falling > margin) & (below + end * falling > margin));
  return (apart[0] | apart[1] | apart[2]) != 0;
}

}  // namespace sprung
