#include "base/format.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace sprung {
namespace {

TEST(FormatNumber, ReadsBackToTheSameBits) {
  std::mt19937_64 random(1);
  int finite = 0;
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    ++finite;
    const std::string text = format_number(value);
    double read = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), read);
    ASSERT_EQ(result.ptr, text.data() + text.size()) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value)) << text;
  }
  EXPECT_GT(finite, 99000);  // 1 in 2048 bit patterns is not finite
}

TEST(FormatNumber, IsTheShortestText) {
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(-2.0), "-2");
  EXPECT_EQ(format_number(-0.0), "-0");
  EXPECT_EQ(format_number(1e300), "1e+300");
}

TEST(FormatNumber, WritesNanAndInfAsWords) {
  EXPECT_EQ(format_number(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(format_number(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(format_number(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(FormatNumber, RoundsToTheGivenDigits) {
  EXPECT_EQ(format_number(0.123456, 3), "0.123");
  EXPECT_EQ(format_number(2.0 / 3.0, 2), "0.67");
}

TEST(FormatUpperBound, IsNeverAboveTheBoundByMoreThanRounding) {
  EXPECT_EQ(format_upper_bound(0.019999999999999997), "0.02");
  EXPECT_EQ(format_upper_bound(0.0123456789), "0.0123456");
  EXPECT_EQ(format_upper_bound(1234567.9), "1.23456e+06");
  EXPECT_EQ(format_upper_bound(1.0 / 30.0, 3), "0.0333");
}

TEST(FormatLowerBound, IsNeverBelowTheBoundByMoreThanRounding) {
  EXPECT_EQ(format_lower_bound(0.020000000000000004), "0.02");
  EXPECT_EQ(format_lower_bound(50.21, 3), "50.3");
  EXPECT_EQ(format_lower_bound(0.0996, 2), "0.1");
}

TEST(AppendNumber, KeepsTheExistingText) {
  std::string text = "x = ";
  append_number(text, 1.5);
  EXPECT_EQ(text, "x = 1.5");
}

TEST(Counted, UsesThePluralExceptForOne) {
  EXPECT_EQ(counted(0, "spring"), "0 springs");
  EXPECT_EQ(counted(1, "spring"), "1 spring");
  EXPECT_EQ(counted(2, "spring"), "2 springs");
}

}  // namespace
}  // namespace sprung
