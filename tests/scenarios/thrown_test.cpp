// Cloths thrown at thin things: a step may take them many times the thickness of what they hit, and of themselves.
#include "base/format.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace sprung::testing {
namespace {

constexpr const char* kAskew = R"(bodies.cloth.place={"position": [0.01, 0.4, 0.02], "rotation": [-40, 25, 0]})";

struct Throw {
  double speed;  ///< [m/s]
  bool askew;
  double step_factor;
};

void PrintTo(const Throw& chosen, std::ostream* stream) {
  *stream << chosen.speed << " m/s" << (chosen.askew ? ", askew" : "") << ", step times " << chosen.step_factor;
}

class ThrownCloth : public ::testing::TestWithParam<Throw> {
 protected:
  [[nodiscard]] static BuiltScene scene(std::vector<std::string> overrides) {
    overrides.push_back(std::string("bodies.cloth.velocity=[0,-").append(format_number(GetParam().speed)).append(",0]"));
    if (GetParam().askew) overrides.emplace_back(kAskew);
    return load_scenario("thrown_cloth", overrides, GetParam().step_factor);
  }
};

std::vector<Throw> all_throws() {
  std::vector<Throw> throws;
  for (const double speed : {5.0, 50.0, 500.0}) {
    for (const bool askew : {false, true}) {
      for (const double step_factor : {1.0, 4.0}) throws.push_back({speed, askew, step_factor});
    }
  }
  return throws;
}
INSTANTIATE_TEST_SUITE_P(Throws, ThrownCloth, ::testing::ValuesIn(all_throws()));

// The sheet is so large that nothing gets around it.
TEST_P(ThrownCloth, StaysOnItsSideOfAThinSheet) {
  double lowest = std::numeric_limits<double>::infinity();
  const ScenarioReport report = run_scenario(scene({}), [&](const Simulator& simulator, const FrameDiagnostics&) {
    lowest = std::min(lowest, simulator.positions().row(1).minCoeff());
  });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(lowest, 0.0);
  EXPECT_LT(lowest, 0.0021) << "it got there";
}

}  // namespace
}  // namespace sprung::testing
