// Cloths thrown at thin obstacles. In one step they may move many times the thickness of the obstacle and their own thickness.
#include "base/format.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace sprung::testing {
namespace {

constexpr const char* kAskew = R"(bodies.cloth.place={"position": [0.01, 0.4, 0.02], "rotation": [-40, 25, 0]})";
constexpr const char* kWideBox =
    R"(obstacles={"box": {"shape": {"type": "box", "size": [20, 0.01, 20]}, "place": {"position": [0, -0.005, 0]}}})";
constexpr const char* kSmallBox =
    R"(obstacles={"box": {"shape": {"type": "box", "size": [0.3, 0.01, 0.3]}, "place": {"position": [0, -0.005, 0]}}})";
constexpr const char* kKnife = R"(obstacles={"knife": {"shape": {"type": "mesh", "file": "knife.obj"}}})";

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

/// The lowest particle of all frames [m].
struct Lowest {
  double y = std::numeric_limits<double>::infinity();
  void operator()(const Simulator& simulator, const FrameDiagnostics& /*frame*/) {
    y = std::min(y, simulator.positions().row(1).minCoeff());
  }
};

// Sheet and box are so wide that nothing gets around them.
TEST_P(ThrownCloth, StaysOnItsSideOfAThinSheet) {
  Lowest lowest;
  const ScenarioReport report = run_scenario(scene({}), std::ref(lowest));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(lowest.y, 0.0);
  EXPECT_LT(lowest.y, 0.0021) << "it reached the obstacle";
}

TEST_P(ThrownCloth, StaysOnItsSideOfAThinBox) {
  Lowest lowest;
  const ScenarioReport report = run_scenario(scene({kWideBox}), std::ref(lowest));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(lowest.y, 0.0);
  EXPECT_LT(lowest.y, 0.0021) << "it reached the obstacle";
}

TEST_P(ThrownCloth, WrapsAroundASmallBoxWithoutCrossingIt) {
  const ScenarioReport report = run_scenario(scene({kSmallBox}));
  EXPECT_TRUE(report.is_free()) << report;
}

TEST_P(ThrownCloth, IsNotCutByAKnife) {
  const ScenarioReport report = run_scenario(scene({kKnife}));
  EXPECT_TRUE(report.is_free()) << report;
}

}  // namespace
}  // namespace sprung::testing
