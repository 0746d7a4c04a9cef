// Coulomb friction of whole bodies: a body slides where the slope exceeds the friction angle, and on level ground it stops after
// its stopping distance.
#include "base/format.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sprung::testing {
namespace {

constexpr double kGravity = 9.81;   // [m/s^2]
constexpr double kFriction = 0.3;   // of the scenes
constexpr double kGroundDepth = 1;  // [m] of the box

/// A slope that goes down along x.
struct Slope {
  double angle;  ///< [rad]
  [[nodiscard]] Vector3 normal() const { return {std::sin(angle), std::cos(angle), 0.0}; }
  [[nodiscard]] Vector3 down() const { return {std::cos(angle), -std::sin(angle), 0.0}; }
  [[nodiscard]] double acceleration() const { return kGravity * (std::sin(angle) - kFriction * std::cos(angle)); }
  /// The pose, as JSON, of a body at `height` [m] above the slope. On level ground it would be rotated by `turn` [degrees] about x.
  [[nodiscard]] std::string pose(double height, double turn) const {
    const double degrees = -angle * 180.0 / std::numbers::pi;
    std::string result = R"({"position": )";
    result.append(json_text(height * normal())).append(R"(, "rotation": )").append(json_text({turn, 0.0, degrees})).append("}");
    return result;
  }
};

/// A slope whose tangent is `factor` times the coefficient of friction.
Slope slope_beyond(double factor) { return {std::atan(kFriction * factor)}; }

/// The distance [m] that the network's centre has moved along a direction, frame by frame.
class Journey {
 public:
  explicit Journey(const Vector3& along) : along_(along) {}
  void operator()(const Simulator& simulator, const FrameDiagnostics& /*frame*/) {
    const Vector3 middle = simulator.positions().rowwise().mean();
    if (distances_.empty()) start_ = middle;
    distances_.push_back(along_.dot(middle - start_));
    fastest_ = simulator.state().v.colwise().norm().maxCoeff();
  }
  [[nodiscard]] double distance() const { return distances_.back(); }
  [[nodiscard]] double distance(std::size_t frame) const { return distances_.at(frame); }
  [[nodiscard]] std::size_t last_frame() const { return distances_.size() - 1; }
  [[nodiscard]] double fastest() const { return fastest_; }

 private:
  Vector3 along_;
  Vector3 start_ = Vector3::Zero();
  std::vector<double> distances_;
  double fastest_ = 0.0;
};

struct Ground {
  const char* name;
  const char* obstacle;
};

void PrintTo(const Ground& ground, std::ostream* stream) { *stream << ground.name; }

const Ground kGrounds[] = {
    {"half_space", R"({"shape": {"type": "half_space"}, "friction": 0.3})"},
    {"box", R"({"shape": {"type": "box", "size": [20, 1, 20]}, "place": {"position": [0, -0.5, 0]}, "friction": 0.3})"},
    {"mesh", R"({"shape": {"type": "mesh", "file": "thin_sheet.obj"}, "place": {"scale": 10}, "friction": 0.3})"},
};

class ClothOnGround : public ::testing::TestWithParam<std::tuple<Ground, double>> {
 protected:
  [[nodiscard]] static BuiltScene scene(std::vector<std::string> overrides) {
    const auto& [ground, step_factor] = GetParam();
    overrides.push_back(std::string("obstacles.ground=").append(ground.obstacle));
    return load_scenario("cloth_on_ground", overrides, step_factor);
  }
};
INSTANTIATE_TEST_SUITE_P(StepFactor, ClothOnGround, ::testing::Combine(::testing::ValuesIn(kGrounds), ::testing::Values(1.0, 4.0)));

TEST_P(ClothOnGround, SlidesIfAndOnlyIfTheSlopeExceedsTheFrictionAngle) {
  for (const double factor : {0.99, 1.01}) {
    const Slope slope = slope_beyond(factor);
    Journey journey(Vector3::UnitX());
    const Vector3 gravity = kGravity * Vector3(std::sin(slope.angle), -std::cos(slope.angle), 0.0);
    const ScenarioReport report =
        run_scenario(scene({std::string("gravity=").append(json_text(gravity)), "duration=1"}), std::ref(journey));
    EXPECT_TRUE(report.is_free()) << report;
    // Verlet is exact for a constant acceleration. The tolerance is the rounding of 240 steps at positions near 1 m.
    EXPECT_NEAR(journey.distance(), std::max(0.0, 0.5 * slope.acceleration()), 1e-10) << "steeper by " << factor;
  }
}

TEST_P(ClothOnGround, StopsAfterItsStoppingDistance) {
  Journey journey(Vector3::UnitX());
  const ScenarioReport report = run_scenario(scene({"bodies.cloth.velocity=[3,0,0]"}), std::ref(journey));
  EXPECT_TRUE(report.is_free()) << report;
  // The distance is exact except for the step in which the cloth stops, which adds less than mu g dt^2, and for the slip that
  // friction takes back, as much at most: a tenth of what is left of it in each step.
  const double stop = 3.0 / (kFriction * kGravity);
  const double slip = kFriction * kGravity * report.step * report.step;
  EXPECT_NEAR(journey.distance(), 0.5 * 3.0 * stop, 2.0 * slip);
  const double steps_since = (2.0 - stop) / report.step - 2.0;
  EXPECT_LT(journey.fastest(), 0.1 * slip / report.step * std::pow(0.9, steps_since));
}

class TiltedGround : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] static std::string ground(const Slope& slope) {
    std::string result = R"(obstacles.ground={"shape": {"type": "box", "size": [20, 1, 20]}, "friction": 0.3, "place": )";
    result.append(slope.pose(-0.5 * kGroundDepth, 0.0)).append("}");
    return result;
  }
};
INSTANTIATE_TEST_SUITE_P(StepFactor, TiltedGround, ::testing::Values(1.0, 4.0));

TEST_P(TiltedGround, StopsAClothIfAndOnlyIfTheSlopeIsBelowTheFrictionAngle) {
  for (const double factor : {0.99, 1.01}) {
    const Slope slope = slope_beyond(factor);
    Journey journey(slope.down());
    const std::string pose = std::string("bodies.cloth.place=").append(slope.pose(0.005, -90.0));
    const ScenarioReport report =
        run_scenario(load_scenario("cloth_on_ground", {ground(slope), pose, "duration=1"}, GetParam()), std::ref(journey));
    EXPECT_TRUE(report.is_free()) << report;
    EXPECT_NEAR(journey.distance(), std::max(0.0, 0.5 * slope.acceleration()), 1e-10) << "steeper by " << factor;
  }
}

// The step of a jelly is as long as its springs allow, so it is tested with a quarter of that step instead of four times as much.
TEST_P(TiltedGround, SlowsAJellyDownIfAndOnlyIfTheSlopeIsBelowTheFrictionAngle) {
  for (const double factor : {0.99, 1.01}) {
    const Slope slope = slope_beyond(factor);
    Journey journey(slope.down());
    const std::string pose = std::string("bodies.jelly.place=").append(slope.pose(0.105, 0.0));
    const ScenarioReport report =
        run_scenario(load_scenario("jelly_on_ground", {ground(slope), pose, "duration=4"}, GetParam() / 4.0), std::ref(journey));
    EXPECT_TRUE(report.is_free()) << report;
    // The jelly begins undeformed and slides farther than a rigid block until it has settled under its weight. Then it accelerates
    // like a rigid block: the distance of the last second exceeds that of the second before by the acceleration times 1 s^2.
    const std::size_t end = journey.last_frame();
    const double gained = journey.distance(end) - 2.0 * journey.distance(end - 60) + journey.distance(end - 120);
    if (factor < 1.0) {
      EXPECT_LT(gained, 0.0);
      EXPECT_LT(journey.fastest(), 1e-3) << "it has come to rest";
    } else {
      EXPECT_NEAR(gained, slope.acceleration(), 0.02 * slope.acceleration());
    }
  }
}

}  // namespace
}  // namespace sprung::testing
