#include "base/machine/tiny_numbers.h"

#include <gtest/gtest.h>

#include <limits>

namespace sprung {
namespace {

// Volatile, so that the compiler does not compute the results.
volatile double least_normal = std::numeric_limits<double>::min();
volatile double tiny = std::numeric_limits<double>::denorm_min();

TEST(TinyNumbers, AreRestoredAfterwards) {
  {
    const TinyNumbersAreZero quick;
#if defined(__SSE2__)
    EXPECT_TRUE(least_normal * 0.5 * 4.0 == 0.0) << "computed here";
    EXPECT_TRUE(tiny * 0x1p200 == 0.0) << "computed before";
#endif
    EXPECT_TRUE(least_normal * 2.0 * 0.5 == least_normal) << "normal numbers do not change";
  }
  EXPECT_TRUE(least_normal * 0.5 * 4.0 == 2.0 * least_normal);
  EXPECT_TRUE(tiny * 0x1p200 > 0.0);
}

}  // namespace
}  // namespace sprung
