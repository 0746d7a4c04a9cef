// What remains of a step that was repeated: the attempt that was kept, and nothing of the others.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using testing::rising_ball;

/// Steps a simulator and counts the substeps of all attempts.
class CountingRun {
 public:
  CountingRun(SpringNetwork network, const SimulatorSettings& settings, std::vector<Obstacle> obstacles)
      : simulator(std::move(network), settings, std::move(obstacles)) {
    simulator.stop_when([this] { return ++made_ < 0; });
  }

  /// Whether attempts were discarded.
  bool step() {
    made_ = 0;
    const StepReport report = simulator.step();
    return made_ > report.substeps;
  }

  Simulator simulator;

 private:
  int made_ = 0;
};

// A particle lies on a plane that rotates. An attempt that is abandoned ends within the step, where the plane has another normal.
TEST(RepeatedStep, KeepsTheNormalsOfTheAttemptThatIsKept) {
  NetworkBuilder builder = testing::rod();
  builder.pin({0, 1});
  builder.begin_body("grain", {.thickness = 0.002});
  const Index grain = builder.add_particle({0.0, -4.998, 0.0}, 0.1);
  Obstacle plane{.name = "plane", .geometry = HalfSpaceGeometry{.offset = -5.0}};
  plane.motion.spin = Vector3(0.0, 0.0, 20.0);
  CountingRun run(builder.build(), {.step = 1e-2}, {rising_ball(), plane});
  int repeated = 0;
  for (int step = 0; step < 10; ++step) {
    repeated += run.step() ? 1 : 0;
    const std::vector<ContactNormal>& normals = run.simulator.state().contact.normals;
    ASSERT_EQ(normals.size(), 1U) << step;
    EXPECT_EQ(normals.front().particle, grain);
    const Vector3 expected = plane.motion.pose(plane.rest_pose, run.simulator.time()).linear() * Vector3::UnitY();
    // The angle of the pose and the rotation of the normal: a few roundings of numbers up to 1.
    EXPECT_LT((normals.front().normal - expected).norm(), 16 * std::numeric_limits<double>::epsilon()) << step;
  }
  EXPECT_GT(repeated, 0) << "the scene must repeat steps";
}

// A solver keeps the factor of a cloth that hangs nearly still, which changes last digits. A discarded attempt leaves none: the
// next step is that of a simulator that begins there.
TEST(RepeatedStep, LeavesNothingOfDiscardedSolves) {
  NetworkBuilder builder = testing::rod();
  builder.pin({0, 1});
  BodyShape cloth = make_cloth({.size = {1.0, 1.0}, .resolution = {10, 10}},
                               {.structural = SpringMaterial{.value = 0.0}, .shear = SpringMaterial{.value = 0.0}});
  set_total_mass(cloth, 0.2);
  place(cloth, RigidTransform(Eigen::Translation3d(5.0, 0.0, 0.0)), Vector3::Zero());
  const Index first = builder.add_body("cloth", cloth);
  builder.pin({first + 90, first + 99});
  const SimulatorSettings settings{.step = 1e-2,
                                   .stretch_limit = StretchLimitSettings{.solver = StretchLimitSettings::Solver::newton}};
  const std::vector<Obstacle> obstacles{rising_ball(1.0)};
  CountingRun run(builder.build(), settings, obstacles);
  int compared = 0;
  for (int step = 0; step < 120; ++step) {
    if (!run.step()) continue;
    const Simulator& simulator = run.simulator;
    Simulator fresh = simulator;
    if (run.step()) continue;
    fresh.step();
    ++compared;
    EXPECT_EQ(fresh.positions(), simulator.positions()) << step;
    EXPECT_EQ(fresh.state().v, simulator.state().v) << step;
  }
  EXPECT_GT(compared, 0) << "the scene must make a step after a repeated one";
}

}  // namespace
}  // namespace sprung
