#include "base/machine/finite.h"

#include "base/machine/kernel.h"

namespace sprung {

// Zero times NaN or infinity is NaN, and so is any sum with it. This is much faster than testing each number. Several sums avoid a
// chain of dependent additions.
SPRUNG_KERNEL
bool are_finite(const double* values, Index count) {
  constexpr Index kSums = 32;
  double sums[kSums] = {};
  Index i = 0;
  for (; i + kSums <= count; i += kSums) {
    for (Index k = 0; k < kSums; ++k) sums[k] += 0.0 * values[i + k];
  }
  double sum = 0.0;
  for (; i < count; ++i) sum += 0.0 * values[i];
  for (const double of_lane : sums) sum += of_lane;
  return sum == 0.0;
}

}  // namespace sprung
