// A body bounces to the square of the restitution times the height from which it fell, for any body, ground and step.
#include "network/network_builder.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace sprung::testing {
namespace {

constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kRestitution = 0.8;  // of the scene
constexpr double kThickness = 0.005;  // [m] of the scene
constexpr double kSceneHeight = 1.0;  // [m], less the thickness

struct Ground {
  const char* name;
  const char* override;
};
void PrintTo(const Ground& ground, std::ostream* stream) { *stream << ground.name; }

const Ground kFloor = {"floor", R"(obstacles.ground={"shape": {"type": "half_space"}})"};
const Ground kBox = {"box",
                     R"(obstacles.ground={"shape": {"type": "box", "size": [4, 1, 4]}, "place": {"position": [0, -0.5, 0]}})"};
const Ground kMesh = {"mesh", R"(obstacles.ground={"shape": {"type": "mesh", "file": "thin_sheet.obj"}, "place": {"scale": 4}})"};
const Ground kBall = {"ball",
                      R"(obstacles.ground={"shape": {"type": "sphere", "radius": 0.5}, "place": {"position": [0, -0.5, 0]}})"};

/// The greatest height [m], less the thickness, of the network's centre between the first and the second bounce.
class FirstBounce {
 public:
  void operator()(const Simulator& simulator, const FrameDiagnostics& /*frame*/) {
    const double height = simulator.positions().row(1).mean() - kThickness;
    const bool rises = height > last_;
    if (rises && !rises_) ++bounces_;
    if (bounces_ == 1) highest_ = std::max(highest_, height);
    rises_ = rises;
    last_ = height;
  }
  [[nodiscard]] double highest() const { return highest_; }

 private:
  double last_ = std::numeric_limits<double>::infinity();
  bool rises_ = false;
  int bounces_ = 0;
  double highest_ = 0.0;
};

/// Positions are known once a step, so the highest one is missed by up to g dt^2 / 8. The start of a scheme adds as much.
double tolerance(double step) { return kGravity * step * step; }

void expect_bounce(BuiltScene scene, double height) {
  FirstBounce bounce;
  const ScenarioReport report = run_scenario(std::move(scene), std::ref(bounce));
  EXPECT_TRUE(report.is_free()) << report;
  const double expected = kRestitution * kRestitution * height;
  EXPECT_NEAR(bounce.highest(), expected, tolerance(report.step)) << "from " << height << " m";
  EXPECT_LT(tolerance(report.step), 0.02 * expected) << "the tolerance is below 2 %";
}

class BounceOfAParticle : public ::testing::TestWithParam<std::tuple<Ground, double, const char*>> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, BounceOfAParticle,
                         ::testing::Combine(::testing::Values(kFloor, kMesh, kBall), ::testing::Values(1.0, 4.0),
                                            ::testing::Values("verlet", "symplectic_euler", "explicit_euler")));

TEST_P(BounceOfAParticle, ReachesTheSquareOfRestitutionTimesTheHeight) {
  const auto& [ground, step_factor, integrator] = GetParam();
  for (const double height : {0.5, 0.77, 1.0}) {
    const std::string scheme = std::string(R"(integrator={"type": ")").append(integrator).append(R"("})");
    BuiltScene scene = load_scenario("bounce", {ground.override, scheme}, step_factor);
    NetworkBuilder builder;
    builder.begin_body("particle", scene.network.bodies.front().material);
    builder.add_particle({0.0, height + kThickness, 0.0}, 0.1);
    scene.network = builder.build();
    expect_bounce(std::move(scene), height);
  }
}

class BounceOfACloth : public ::testing::TestWithParam<std::tuple<Ground, double>> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, BounceOfACloth,
                         ::testing::Combine(::testing::Values(kFloor, kBox, kMesh), ::testing::Values(1.0, 4.0)));

TEST_P(BounceOfACloth, DroppedFlatItReachesTheSquareOfRestitutionTimesTheHeight) {
  const auto& [ground, step_factor] = GetParam();
  expect_bounce(load_scenario("bounce", {ground.override}, step_factor), kSceneHeight);
}

/// The part of its height that a ball of a material rebounds to. It falls by 0.45 m less the thickness.
double rebound_of(const std::string& material, int cells) {
  constexpr double kRadius = 0.15;
  FirstBounce bounce;
  const ScenarioReport report = run_scenario(
      load_scenario("rebound", {"bodies.ball.material=\"" + material + "\"", "bodies.ball.shape.cells=" + std::to_string(cells)}),
      std::ref(bounce));
  EXPECT_TRUE(report.is_free()) << report;
  return (bounce.highest() - kRadius) / (0.6 - kRadius - kThickness);
}

// The internal damping of materials acts on relative motion alone, so a rebound depends on the ball, not on its resolution. Foams
// rebound to 30 to 60 % (ASTM D3574), rubber to 60 to 85 %, gels to less than a half.
TEST(BounceOfAMaterial, IsThatOfTheMaterialAtAnyResolution) {
  const double foam = rebound_of("foam", 6);
  EXPECT_GT(foam, 0.3);
  EXPECT_LT(foam, 0.6);
  EXPECT_NEAR(rebound_of("foam", 8) / foam, 1.0, 0.1);
  const double rubber = rebound_of("rubber_block", 6);
  EXPECT_GT(rubber, foam);
  EXPECT_LT(rubber, 0.85);
  EXPECT_NEAR(rebound_of("rubber_block", 8) / rubber, 1.0, 0.1);
  EXPECT_LT(rebound_of("firm_jelly", 6), 0.5);
  EXPECT_LT(rebound_of("soft_jelly", 6), 0.5);
}

}  // namespace
}  // namespace sprung::testing
