#include "collision/core/block_bounds.h"

#include "base/kernel.h"
#include "base/simd.h"

#include <limits>

namespace sprung {

namespace {

template <class Particle>
[[gnu::always_inline]] inline Box3 bounds_of(const Points& positions, Index count, const Particle& particle) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  Double4 low = Double4{} + kLargest;
  Double4 high = Double4{} - kLargest;
  Double4 zero{};  // stays 0 while all positions are finite, else NaN
  for (Index k = 0; k < count; ++k) {
    const double* p = positions.data() + 3 * static_cast<std::ptrdiff_t>(particle(k));
    const Double4 position = {p[0], p[1], p[2], p[0]};
    low = position < low ? position : low;
    high = position > high ? position : high;
    zero += 0.0 * position;
  }
  if (zero[0] + zero[1] + zero[2] == 0.0) return {Vector3(low[0], low[1], low[2]), Vector3(high[0], high[1], high[2])};
  Box3 box;
  for (Index k = 0; k < count; ++k) {
    const auto position = positions.col(particle(k));
    if (position.allFinite()) box.extend(position);
  }
  return box;
}

}  // namespace

SPRUNG_KERNEL Box3 finite_bounds(const Points& positions, Index begin, Index end) {
  return bounds_of(positions, end - begin, [&](Index k) { return begin + k; });
}

SPRUNG_KERNEL Box3 finite_bounds(const Points& positions, std::span<const Index> particles) {
  return bounds_of(positions, static_cast<Index>(particles.size()),
                   [&](Index k) { return particles[static_cast<std::size_t>(k)]; });
}

Box3 grown(const Box3& box, double distance) {
  if (box.isEmpty()) return box;
  const double rounding = 1e-9 * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const Vector3 margin = Vector3::Constant(distance + rounding);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace sprung
