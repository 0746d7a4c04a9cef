#include "dynamics/numerics/front_kernel.h"

#include "base/machine/kernel.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace sprung {
namespace {

/// The defined entries of an eliminated panel: columns of L, 1 / D, and the lower triangle of the update.
template <class Number>
struct Eliminated {
  std::vector<Number> numbers;
  bool positive = false;
};

template <class Number>
using Eliminate = bool (*)(const FrontShape&, Number*, Number*, Number*, Number*);

template <class Number>
Eliminated<Number> eliminated(const FrontShape& shape, std::vector<Number> panel, Eliminate<Number> eliminate) {
  const auto width = static_cast<std::size_t>(shape.width());
  const auto height = static_cast<std::size_t>(shape.lower_height());
  std::vector<Number> inverse(width);
  std::vector<Number> update(height * height);
  std::vector<Number> row(kRowRoom * width);
  Eliminated<Number> result;
  result.positive = eliminate(shape, panel.data(), inverse.data(), update.data(), row.data());
  result.numbers = inverse;
  for (Index c = 0; c < shape.width(); ++c) {
    for (Index r = c + 1; r < shape.width() + shape.lower_height(); ++r) result.numbers.push_back(panel[shape.index(r, c)]);
  }
  for (std::size_t c = 0; c < height; ++c)
    result.numbers.insert(result.numbers.end(), &update[c * height + c], &update[c * height] + height);
  return result;
}

// On a machine with AVX-512 the chosen kernel has twice as many lanes. A diagonal larger than its row makes the matrix positive
// definite.
template <class Number>
void expect_the_same_bits() {
  std::mt19937 random(8);
  std::uniform_real_distribution<Number> unit(-1, 1);
  for (Index own = 1; own < 12; ++own) {
    for (const Index lower : {0, 1, 2, 3, 5, 8, 13, 15}) {
      const FrontShape shape{own, lower};
      std::vector<Number> panel(shape.size());
      for (Number& number : panel) number = unit(random);
      for (Index i = 0; i < shape.width(); ++i) panel[shape.index(i, i)] = static_cast<Number>(1 + shape.width());
      const auto narrow = eliminated<Number>(shape, panel, eliminate_front_narrow);
      const auto chosen = eliminated<Number>(shape, panel, eliminate_front<Number>);
      EXPECT_TRUE(narrow.positive && chosen.positive);
      EXPECT_EQ(narrow.numbers, chosen.numbers) << own << " and " << lower;
    }
  }
}

TEST(FrontKernel, GivesTheSameBitsWithAnyLaneCount) {
  if (!has_wide_lanes()) GTEST_SKIP() << "this machine has no AVX-512, so both are the same code";
  expect_the_same_bits<double>();
  expect_the_same_bits<float>();
}

}  // namespace
}  // namespace sprung
