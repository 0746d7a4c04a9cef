#include "base/finite.h"

#include "base/kernel.h"

namespace sprung {

// Zero times what is not finite is no number, and nor is a sum with it: far faster than asking each. One sum would wait for itself.
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
