// Cloths that obstacles push around their pins.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

/// Parameters: the time [s] in which the bar rises by 0.1 m or the pins sink by 0.1 m; whether the pins sink; particles along the
/// cloth; the factor of the step; whether the cloth has self-contact.
class LiftedBesideItsPins : public ::testing::TestWithParam<std::tuple<double, bool, int, double, bool>> {};
INSTANTIATE_TEST_SUITE_P(Lift, LiftedBesideItsPins,
                         ::testing::Combine(::testing::Values(0.2, 0.05, 0.01), ::testing::Bool(), ::testing::Values(8, 24),
                                            ::testing::Values(1.0, 4.0), ::testing::Bool()));

std::string sinking(double time) {
  const std::string t = std::to_string(time);
  return R"(bodies.cloth.pins[0].motion={"keyframes": [{"time": 0}, {"time": )" + t + R"(, "position": [0, 0, -0.1]}, )" +
         R"({"time": 1, "position": [0, 0, -0.1]}]})";
}

// A bar rises through the plane of a cloth, 3 cm beside the pins. It moves the next row of the cloth, 9 or 29 cm from the pins, up
// to ten times as fast as itself.
TEST_P(LiftedBesideItsPins, TheClothRotatesAboutThem) {
  const auto [rise, pins_sink, columns, step_factor, self] = GetParam();
  std::vector<std::string> overrides = {"bodies.cloth.shape.resolution=[" + std::to_string(columns) + ", 3]",
                                        "bodies.cloth.self_contact=" + std::string(self ? "true" : "false")};
  if (pins_sink) {
    overrides.push_back("obstacles.bar.motion.keyframes=[{\"time\": 0}]");
    overrides.push_back(sinking(rise));
  } else {
    overrides.push_back("obstacles.bar.motion.keyframes[1].time=" + std::to_string(rise));
  }
  Points risen;
  const auto watch = [&, rise = rise](const Simulator& simulator, const FrameDiagnostics& frame) {
    if (risen.cols() == 0 && frame.time >= rise) risen = simulator.positions();
  };
  const ScenarioReport report = run_scenario(load_scenario("lifted_beside_pins", overrides, step_factor), watch);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
  // At this time the bar is 3 cm beside and 5 cm above the pins. The line from the pins to the next row must pass above the bar. A
  // faster bar has thrown the row over the pins.
  for (Index row = 0; rise == 0.2 && row < 3; ++row) {
    const Vector3 next = risen.col(row * columns + 1) - risen.col(row * columns);
    EXPECT_GT(0.03 * next.z() - 0.05 * next.x(), 0.0) << "row " << row;
  }
}

TEST(LiftedBesidePins, AnInfeasibleStepIsRepeatedInSubsteps) {
  const std::vector<std::string> overrides = {"bodies.cloth.shape.resolution=[8, 3]",
                                              "obstacles.bar.motion.keyframes[1].time=0.05"};
  BuiltScene scene = load_scenario("lifted_beside_pins", overrides);
  const std::int64_t steps = static_cast<std::int64_t>(scene.frames - 1) * scene.settings.steps_per_frame;
  std::int64_t substeps = 0;
  const ScenarioReport report =
      run_scenario(std::move(scene), [&](const Simulator&, const FrameDiagnostics& frame) { substeps += frame.substeps; });
  EXPECT_EQ(report.infeasible, 0) << report;
  EXPECT_GT(substeps, steps);
  EXPECT_LT(substeps, steps + 2 * 64) << "only few steps are divided";
}

// A rope with both ends pinned lies across the path of the bar, beside the cloth. It becomes permanently infeasible: depending on
// its height, a step before the cloth would, in the same step, or after it.
TEST(LiftedBesidePins, APermanentlyInfeasibleRopeDoesNotPreventOtherRepeats) {
  for (const double height : {-0.03, -0.02, -0.01, -0.004}) {
    const std::string z = std::to_string(height);
    const std::vector<std::string> overrides = {
        "bodies.cloth.shape.resolution=[8, 3]", "obstacles.bar.motion.keyframes[1].time=0.05",
        R"(bodies.rope={"shape": {"type": "rope", "points": [[-1.2, 0.15, )" + z + "], [-0.8, 0.15, " + z +
            R"(]], "particles": 2}, "mass": 0.01, "springs": {"structural": {"stiffness": 0}}, "body_contact": false,)"
            R"("thickness": 0.002, "pins": [{"indices": [0, 1]}]})"};
    Points risen;
    const ScenarioReport report = run_scenario(
        load_scenario("lifted_beside_pins", overrides),
        [&](const Simulator& simulator, const FrameDiagnostics& frame) {
          if (risen.cols() == 0 && frame.time >= 0.05) risen = simulator.positions();
        },
        Judge::nothing);
    EXPECT_GT(report.infeasible, 0) << height;
    const Vector3 next = risen.col(1) - risen.col(0);
    EXPECT_GT(0.03 * next.z() - 0.05 * next.x(), 0.0) << height;
  }
}

/// The final velocity [m/s] of a cloth that flies far away, and the total number of substeps.
std::pair<Vector3, std::int64_t> flight_far_away(const std::string& integrator, const std::string& bar_position) {
  const std::vector<std::string> overrides = {
      "bodies.cloth.shape.resolution=[8, 3]", "obstacles.bar.motion.keyframes[1].time=0.05",
      "obstacles.bar.place.position=" + bar_position, "integrator=" + integrator,
      R"(bodies.far={"shape": {"type": "cloth", "size": [1, 1], "resolution": [2, 2]}, "mass": 1, "velocity": [1, 0, 0],)"
      R"("springs": {"structural": {"stiffness": 0}}, "place": {"position": [0, 9, 0]}})"};
  Vector3 velocity;
  std::int64_t substeps = 0;
  run_scenario(
      load_scenario("lifted_beside_pins", overrides),
      [&](const Simulator& simulator, const FrameDiagnostics& frame) {
        velocity = simulator.state().v.rightCols(4).rowwise().mean();
        substeps += frame.substeps;
      },
      Judge::nothing);
  return {velocity, substeps};
}

// Verlet damps once a step, whatever the number of substeps.
TEST(LiftedBesidePins, ARepeatedStepDampsADistantClothOnce) {
  for (const char* integrator : {R"({"type": "verlet", "damping": 0.05})", R"({"type": "verlet", "damping_rate": 3})",
                                 R"({"type": "verlet"})", R"({"type": "symplectic_euler"})"}) {
    const auto [with_bar, substeps] = flight_far_away(integrator, "[-0.97, 0, -0.05]");
    const auto [without, steps] = flight_far_away(integrator, "[-0.97, 50, -0.05]");
    EXPECT_GT(substeps, steps) << integrator;
    EXPECT_NEAR(with_bar.x(), without.x(), 1e-9) << integrator;
  }
}

}  // namespace
}  // namespace sprung::testing
