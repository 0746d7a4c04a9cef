#include "dynamics/front_kernel.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace sprung {
namespace {

/// What elimination made of a panel, but for what is not meant: columns of L, 1 / D, and the lower triangle of what is handed on.
struct Eliminated {
  std::vector<double> numbers;
  bool positive = false;
};

Eliminated eliminated(const FrontShape& shape, std::vector<double> panel, decltype(&eliminate_front_narrow) eliminate) {
  const auto width = static_cast<std::size_t>(shape.width());
  const auto height = static_cast<std::size_t>(shape.lower_height());
  std::vector<double> inverse(width);
  std::vector<double> update(height * height);
  std::vector<double> row(kRowRoom * width);
  Eliminated result;
  result.positive = eliminate(shape, panel.data(), inverse.data(), update.data(), row.data());
  result.numbers = inverse;
  for (Index c = 0; c < shape.width(); ++c) {
    for (Index r = c + 1; r < shape.width() + shape.lower_height(); ++r) result.numbers.push_back(panel[shape.place(r, c)]);
  }
  for (std::size_t c = 0; c < height; ++c)
    result.numbers.insert(result.numbers.end(), &update[c * height + c], &update[c * height] + height);
  return result;
}

// What the machine takes has twice as many lanes where it has AVX-512. A diagonal larger than its row makes the matrix positive
// definite.
TEST(FrontKernel, HasTheSameBitsWhateverTheMachineTakes) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (Index own = 1; own < 6; ++own) {
    for (Index lower = 0; lower < 8; ++lower) {
      const FrontShape shape{own, lower};
      std::vector<double> panel(shape.size());
      for (double& number : panel) number = unit(random);
      for (Index i = 0; i < shape.width(); ++i) panel[shape.place(i, i)] = 1.0 + shape.width();
      const Eliminated narrow = eliminated(shape, panel, eliminate_front_narrow);
      const Eliminated taken = eliminated(shape, panel, eliminate_front);
      EXPECT_TRUE(narrow.positive && taken.positive);
      EXPECT_EQ(narrow.numbers, taken.numbers) << own << " and " << lower;
    }
  }
}

}  // namespace
}  // namespace sprung
