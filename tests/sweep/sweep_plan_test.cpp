#include "sweep/sweep_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace sprung {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Le;

std::string refusal(const SweepRequest& request) {
  try {
    const SweepPlan plan(request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<double> samples_of(const std::string& distribution, int count) {
  const SweepPlan plan({.sample = {"key=" + distribution}, .count = count, .seed = 7});
  std::vector<double> numbers;
  for (const std::string& value : plan.values_of_key(0)) numbers.push_back(std::stod(value));
  return numbers;
}

TEST(SweepPlan, SplitsValuesOutsideOfBracketsAndStrings) {
  EXPECT_THAT(split_values("1,2.5"), ElementsAre("1", "2.5"));
  EXPECT_THAT(split_values("[1,2],[3,[4]]"), ElementsAre("[1,2]", "[3,[4]]"));
  EXPECT_THAT(split_values(R"({"a":1,"b":2},"x,\"y",z)"), ElementsAre(R"({"a":1,"b":2})", R"("x,\"y")", "z"));
  EXPECT_THAT(split_values("1,"), ElementsAre("1", ""));
}

TEST(SweepPlan, RunsEachCombinationOfGridsTheLastFastest) {
  const SweepPlan plan({.vary = {"a=1,2", "b=x,y,z"}});
  ASSERT_EQ(plan.run_count(), 6);
  EXPECT_THAT(plan.keys(), ElementsAre("a", "b"));
  EXPECT_THAT(plan.values_of(1), ElementsAre("1", "x"));
  EXPECT_THAT(plan.values_of(2), ElementsAre("1", "y"));
  EXPECT_THAT(plan.values_of(6), ElementsAre("2", "z"));
  EXPECT_THAT(overrides_of(plan, 4), ElementsAre("a=2", "b=x"));
}

TEST(SweepPlan, GridPointsShareTheirSamples) {
  const SweepPlan plan({.vary = {"a=1,2"}, .sample = {"b=uniform(0,1)", "c=uniform(0,1)"}, .count = 3, .seed = 4});
  ASSERT_EQ(plan.run_count(), 6);
  for (int k = 1; k <= 3; ++k) {
    const std::vector<std::string> one = plan.values_of(k);
    const std::vector<std::string> other = plan.values_of(k + 3);
    EXPECT_NE(one[0], other[0]);
    EXPECT_EQ(one[1], other[1]);
    EXPECT_EQ(one[2], other[2]);
    EXPECT_NE(one[1], one[2]) << "each key has samples of its own";
  }
}

TEST(SweepPlan, SamplesDependOnTheSeedAndNotOnTheirCount) {
  const SweepRequest few{.sample = {"a=uniform(0,1)"}, .count = 2, .seed = 1};
  SweepRequest many = few;
  many.count = 5;
  SweepRequest other = few;
  other.seed = 2;
  EXPECT_EQ(SweepPlan(few).values_of(2), SweepPlan(many).values_of(2));
  EXPECT_NE(SweepPlan(few).values_of(2), SweepPlan(other).values_of(2));
}

TEST(SweepPlan, SamplesFollowTheirDistributions) {
  constexpr int kCount = 4000;
  double sum = 0.0;
  for (const double value : samples_of("uniform(2,4)", kCount)) {
    EXPECT_THAT(value, AllOf(Ge(2.0), Le(4.0)));
    sum += value;
  }
  EXPECT_NEAR(sum / kCount, 3.0, 0.05);  // five standard errors of 2 / sqrt(12 * 4000)

  sum = 0.0;
  for (const double value : samples_of("log_uniform(0.01,100)", kCount)) {
    EXPECT_THAT(value, AllOf(Ge(0.01), Le(100.0)));
    sum += std::log10(value);
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.1);  // of 4 / sqrt(12 * 4000)

  std::set<double> seen;
  for (const double value : samples_of("integer(-1,2)", kCount)) seen.insert(value);
  EXPECT_THAT(seen, ElementsAre(-1.0, 0.0, 1.0, 2.0));

  sum = 0.0;
  double squares = 0.0;
  for (const double value : samples_of("normal(5,2)", kCount)) {
    sum += value;
    squares += (value - 5.0) * (value - 5.0);
  }
  EXPECT_NEAR(sum / kCount, 5.0, 0.16);      // of 2 / sqrt(4000)
  EXPECT_NEAR(squares / kCount, 4.0, 0.45);  // of 4 sqrt(2 / 4000)
}

TEST(SweepPlan, NamesEveryProblemInOneGo) {
  const std::string text = refusal({.vary = {"a=", "b", "c=1,,2", "c=3", "d=1,1"}, .sample = {"e=uniform(2,1)", "f=gauss(1,2)"}});
  EXPECT_THAT(text, HasSubstr("--vary = a=: the range is empty"));
  EXPECT_THAT(text, HasSubstr("--vary = b: is not of the form KEY=V1,V2,..."));
  EXPECT_THAT(text, HasSubstr("a value is empty"));
  EXPECT_THAT(text, HasSubstr("--vary = c: the key is given twice"));
  EXPECT_THAT(text, HasSubstr("1 is given twice"));
  EXPECT_THAT(text, HasSubstr("--sample = e=uniform(2,1): the range is empty"));
  EXPECT_THAT(text, HasSubstr("--sample = f=gauss(1,2): is no distribution of a key; write KEY=uniform(a,b)"));
  EXPECT_THAT(text, HasSubstr("--count: --sample needs the number of samples"));
}

TEST(SweepPlan, RefusesRangesThatHaveNoValues) {
  EXPECT_THAT(refusal({}), HasSubstr("nothing varies"));
  EXPECT_THAT(refusal({.vary = {"a=1"}, .count = 3}), HasSubstr("nothing is sampled"));
  EXPECT_THAT(refusal({.sample = {"a=log_uniform(0,1)"}, .count = 1}), HasSubstr("greater than 0"));
  EXPECT_THAT(refusal({.sample = {"a=uniform(-1e308,1e308)"}, .count = 1}), HasSubstr("the range is too wide"));
  EXPECT_THAT(refusal({.sample = {"a=integer(0.5,1)"}, .count = 1}), HasSubstr("must be integers"));
  EXPECT_THAT(refusal({.sample = {"a=normal(1,0)"}, .count = 1}), HasSubstr("standard deviation"));
  EXPECT_THAT(refusal({.vary = {"a=1,2"}, .sample = {"b=uniform(0,1)"}, .count = 600'000}), HasSubstr("at most 1000000"));
}

TEST(SweepPlan, NamesOfRunsSortByNumber) {
  EXPECT_EQ(run_name(1), "0001");
  EXPECT_EQ(run_name(9999), "9999");
  EXPECT_EQ(run_name(10'000), "10000");
}

}  // namespace
}  // namespace sprung
