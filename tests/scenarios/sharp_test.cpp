// Tips, edges and rings that are finer than the network's cells and may touch no particle at all.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung::testing {
namespace {

class Sharp : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, Sharp, ::testing::Values(1.0, 4.0));

/// The highest particle at the end [m].
struct Highest {
  double y = 0.0;
  void operator()(const Simulator& simulator, const FrameDiagnostics& /*frame*/) { y = simulator.positions().row(1).maxCoeff(); }
};

constexpr double kTip = 0.55;  // [m] above the ground, of the spike and of the cone

TEST_P(Sharp, ACoarseClothHangsOnASpike) {
  Highest highest;
  const ScenarioReport report = run_scenario(load_scenario("cloth_on_spike", {}, GetParam()), std::ref(highest));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(highest.y, 0.9 * kTip);
}

TEST_P(Sharp, ACoarseClothHangsOnACone) {
  const char* const cone = R"(obstacles={"cone": {"shape": {"type": "cone", "radius": 0.08, "height": 0.5}, "friction": 0.3,
                                                  "place": {"position": [0, 0.3, 0]}}})";
  Highest highest;
  const ScenarioReport report = run_scenario(load_scenario("cloth_on_spike", {cone}, GetParam()), std::ref(highest));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(highest.y, 0.9 * kTip);
}

// The spike moves up by 3 m at 30 m/s.
TEST_P(Sharp, ASpikeShotUpLiftsACoarseCloth) {
  const char* const shot = R"(obstacles.spike.motion={"keyframes": [{"time": 0}, {"time": 0.1, "position": [0, 3, 0]}]})";
  Highest highest;
  const ScenarioReport report =
      run_scenario(load_scenario("cloth_on_spike", {shot, "duration=0.2"}, GetParam()), std::ref(highest));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(highest.y, 3.0 + 0.9 * kTip);
}

TEST_P(Sharp, ARopeHangsOverAKnife) {
  Highest highest;
  const ScenarioReport report = run_scenario(load_scenario("rope_on_knife", {}, GetParam()), std::ref(highest));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(highest.y, -0.05) << "the edge is at 0 m";
}

/// The number of passages of the rope through the hole of the torus: those from below to above minus those from above to below.
int passages_through_torus(const Simulator& simulator) {
  constexpr double kRing = 0.5;  // [m]
  const Obstacle& torus = simulator.obstacles().front();
  const Points x = torus.motion.pose(torus.rest_pose, simulator.time()).inverse() * simulator.positions();
  int passages = 0;
  for (Index i = 0; i + 1 < x.cols(); ++i) {
    const double below = x(1, i);
    const double above = x(1, i + 1);
    if ((below < 0.0) == (above < 0.0)) continue;
    const Vector3 crossing = x.col(i) + below / (below - above) * (x.col(i + 1) - x.col(i));
    if (crossing.norm() < kRing) passages += below < 0.0 ? 1 : -1;
  }
  return passages;
}

TEST_P(Sharp, ARopeThroughATorusStaysThroughIt) {
  const ScenarioReport report = run_scenario(load_scenario("rope_through_torus", {}, GetParam()),
                                             [](const Simulator& simulator, const FrameDiagnostics& frame) {
                                               ASSERT_EQ(passages_through_torus(simulator), -1) << "frame " << frame.frame;
                                             });
  EXPECT_TRUE(report.is_free()) << report;
}

// The suggested step lets a rope that hangs at rest exceed the limit by half the limit and the tolerance, 0.011, and relaxation
// leaves a third of that. The dragged rope swings at up to 4.5 m/s in bends of radius 1 m: its centripetal acceleration of 2 g and
// its weight make three times as much.
TEST(DraggedRope, KeepsItsLength) {
  const ScenarioReport report = run_scenario(load_scenario("rope_through_torus"), {}, Judge::nothing);
  EXPECT_LT(report.max_stretch, 0.02 + 0.011) << report;
}

// A cloth without thickness comes as near as rounding allows. The direction between two nearly equal points is no usable normal.
TEST(Thin, AClothWithoutThicknessHangsOverPrimitives) {
  for (const char* shape : {R"({"type": "box", "size": [0.3, 0.5, 0.3]})", R"({"type": "cylinder", "radius": 0.2, "height": 0.5})",
                            R"({"type": "cone", "radius": 0.25, "height": 0.5})"}) {
    for (const char* motion : {"{}", R"({"spin": [0, 573, 0]})"}) {
      std::string obstacle = R"(obstacles.bunny={"shape": )";
      obstacle.append(shape).append(R"(, "place": {"position": [0, 0.1, 0]}, "motion": )").append(motion).append("}");
      const ScenarioReport report = run_scenario(load_scenario(
          "drape", {obstacle, "duration=1", "frame_rate=60", R"(integrator={"type": "verlet"})", "bodies.cloth.thickness=0",
                    "bodies.cloth.friction=0", "bodies.cloth.mass=0.1", "bodies.cloth.shape.size=[0.6,0.6]",
                    "bodies.cloth.shape.resolution=[12,12]", "bodies.cloth.place.position=[0,0.4,0]"}));
      EXPECT_TRUE(report.is_free()) << shape << motion << report;
      EXPECT_EQ(report.infeasible, 0) << shape << motion;
    }
  }
}

}  // namespace
}  // namespace sprung::testing
