#include "collision/core/spatial_partition.h"

#include <algorithm>
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

}  // namespace

void bisect(const Points& middles, std::size_t most, std::vector<Index>& order, std::size_t begin, std::size_t end,
            std::vector<std::size_t>& starts) {
  if (begin == end) return;
  Bisection(middles, order).cut(begin, end, (end - begin + most - 1) / most, starts);
}

}  // namespace sprung
