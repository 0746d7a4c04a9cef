// Seeds of random tests: the same in every run of CI, new ones on request, as in nightly runs.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <iostream>

namespace sprung::test {

/// The number in the environment variable SPRUNG_TEST_SEED, 0 without it.
inline std::uint64_t test_seed() {
  const char* text = std::getenv("SPRUNG_TEST_SEED");
  return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
}

/// `seed` itself if SPRUNG_TEST_SEED is 0; otherwise a mix of both (SplitMix64, Steele et al. 2014).
inline std::uint64_t seeded(std::uint64_t seed) {
  if (test_seed() == 0) return seed;
  std::uint64_t mixed = seed + test_seed() * 0x9e3779b97f4a7c15U;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9U;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebU;
  return mixed ^ (mixed >> 31);
}

/// A test whose random numbers depend on SPRUNG_TEST_SEED. After a failure it prints how to repeat the test.
class SeededTest : public ::testing::Test {
 protected:
  void TearDown() override {
    if (!HasFailure()) return;
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    std::cout << "To repeat: SPRUNG_TEST_SEED=" << test_seed() << " and --gtest_filter=" << test.test_suite_name() << '.'
              << test.name() << '\n';
  }
};

}  // namespace sprung::test
