#include "base/machine/finite.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace sprung {
namespace {

// Counts around the number of values that the kernel takes at a time.
TEST(Finite, FindsASingleNonFiniteValueAtAnyPosition) {
  for (const Index count : {1, 3, 31, 32, 33, 64, 100}) {
    std::vector<double> values(static_cast<std::size_t>(count), std::numeric_limits<double>::max());
    EXPECT_TRUE(are_finite(values.data(), count)) << count;
    for (double& value : values) {
      const double original = value;
      for (const double not_finite : {HUGE_VAL, -HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
        value = not_finite;
        EXPECT_FALSE(are_finite(values.data(), count)) << &value - values.data() << " of " << count;
      }
      value = original;
    }
  }
}

TEST(Finite, NoValuesCountAsFinite) { EXPECT_TRUE(are_finite(nullptr, 0)); }

}  // namespace
}  // namespace sprung
