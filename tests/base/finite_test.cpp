#include "base/finite.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace sprung {
namespace {

// Counts around those that the kernel takes at a time.
TEST(Finite, OneValueThatIsNotIsFoundWhereverItIs) {
  for (const Index count : {1, 3, 31, 32, 33, 64, 100}) {
    std::vector<double> values(static_cast<std::size_t>(count), std::numeric_limits<double>::max());
    EXPECT_TRUE(are_finite(values.data(), count)) << count;
    for (double& value : values) {
      const double kept = value;
      for (const double infinity : {HUGE_VAL, -HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
        value = infinity;
        EXPECT_FALSE(are_finite(values.data(), count)) << &value - values.data() << " of " << count;
      }
      value = kept;
    }
  }
}

TEST(Finite, NoValueAtAllIsNotInfinite) { EXPECT_TRUE(are_finite(nullptr, 0)); }

}  // namespace
}  // namespace sprung
