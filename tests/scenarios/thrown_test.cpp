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

// Stiff springs without a limit take inner substeps. Contacts of the whole contact step miss what springs do amid it: surfaces then
// stop one end of a spring and not the other, and the strain would become speed. Dampers, friction and impacts only take energy.
TEST(ThrownSprings, GainNoEnergyAtASpike) {
  const std::string springs = R"(bodies.cloth.springs={"structural": {"stiffness": 500, "damping": 0.02},
      "shear": {"stiffness": 200, "damping": 0.01}, "bend": {"stiffness": 5}})";
  BuiltScene scene =
      load_scenario("cloth_on_spike", {springs, "stretch_limit=null", "bodies.cloth.shape.resolution=[33,33]",
                                       "bodies.cloth.self_contact=true", "bodies.cloth.velocity=[0,-8,0]", "duration=0.5"});
  ASSERT_GT(scene.settings.inner_substeps, 1);
  double first = 0.0;
  double most = 0.0;
  const Watch watch = [&](const Simulator&, const FrameDiagnostics& frame) {
    const double energy = frame.kinetic_energy + frame.elastic_energy + frame.gravity_energy;
    if (frame.frame == 1) first = energy;
    most = std::max(most, energy);
  };
  const ScenarioReport report = run_scenario(std::move(scene), watch);
  EXPECT_TRUE(report.is_free()) << report;
  // Verlet's velocity is half a step old: the energy of a swing of a quarter of a period is off by a few per cent.
  EXPECT_LT(most, 1.05 * first);
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
