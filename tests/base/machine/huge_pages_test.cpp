#include "base/machine/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace sprung {
namespace {

constexpr std::size_t kNumbersOfAPage = HugePageAllocator<float>::kHugePage / sizeof(float);

// A growing vector moves from the ordinary allocator to huge pages, which it does not always fill.
TEST(HugePages, AGrowingVectorKeepsItsNumbers) {
  LargeVector<float> numbers;
  for (std::size_t k = 0; k < 3 * kNumbersOfAPage + 1; ++k) numbers.push_back(static_cast<float>(k % 1024));
  numbers.shrink_to_fit();
  for (std::size_t k = 0; k < numbers.size(); ++k) ASSERT_EQ(numbers[k], static_cast<float>(k % 1024)) << k;
}

TEST(HugePages, ArraysLargerThanAHugePageAreAlignedToOne) {
  const LargeVector<float> small(kNumbersOfAPage - 1);
  const LargeVector<float> large(kNumbersOfAPage + 1);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % HugePageAllocator<float>::kHugePage, 0U);
  EXPECT_EQ(small.front() + large.back(), 0.0F);
}

}  // namespace
}  // namespace sprung
