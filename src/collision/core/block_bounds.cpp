#include "collision/core/block_bounds.h"

#include "base/machine/kernel.h"
#include "base/machine/simd.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sprung {
namespace {

class Bisection {
 public:
  Bisection(const Points& middles, std::vector<Index>& order) : middles_(middles), order_(order) {}

  void cut(std::size_t begin, std::size_t end, std::size_t groups, std::vector<std::size_t>& starts) {
    const auto at = [&](std::size_t slot) { return order_.begin() + static_cast<std::ptrdiff_t>(slot); };
    if (groups == 1) {
      std::sort(at(begin), at(end));
      starts.push_back(begin);
      return;
    }
    const std::size_t middle = begin + (end - begin) * (groups / 2) / groups;
    const int axis = longest_axis(begin, end);
    // Ties are broken by number, so that the result does not depend on the standard library.
    std::nth_element(at(begin), at(middle), at(end),
                     [&](Index a, Index b) { return std::pair(middles_(axis, a), a) < std::pair(middles_(axis, b), b); });
    cut(begin, middle, groups / 2, starts);
    cut(middle, end, groups - groups / 2, starts);
  }

 private:
  [[nodiscard]] int longest_axis(std::size_t begin, std::size_t end) const {
    Box3 box;
    for (std::size_t slot = begin; slot < end; ++slot) box.extend(middles_.col(order_[slot]));
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    return axis;
  }

  const Points& middles_;
  std::vector<Index>& order_;
};

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

void bisect(const Points& middles, std::size_t most, std::vector<Index>& order, std::size_t begin, std::size_t end,
            std::vector<std::size_t>& starts) {
  if (begin == end) return;
  Bisection(middles, order).cut(begin, end, (end - begin + most - 1) / most, starts);
}

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
