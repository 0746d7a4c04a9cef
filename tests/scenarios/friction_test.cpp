// Coulomb friction of whole bodies: what is steeper than friction holds slides, and what slides stops where it should.
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
  /// Where a body lies on it, `height` [m] above, when it lies level with `turn` [degrees] about x.
  [[nodiscard]] std::string place(double height, double turn) const {
    const double degrees = -angle * 180.0 / std::numbers::pi;
    std::string result = R"({"position": )";
    result.append(json_text(height * normal())).append(R"(, "rotation": )").append(json_text({turn, 0.0, degrees})).append("}");
    return result;
  }
};

/// A slope that is steeper by `factor` than what friction holds.
Slope slope_beyond(double factor) { return {std::atan(kFriction * factor)}; }

/// How far the middle of the network has moved [m], frame by frame.
class Journey {
 public:
  explicit Journey(const Vector3& along) : along_(along) {}
  void operator()(const Simulator& simulator, const FrameDiagnostics& /*frame*/) {
    const Vector3 middle = simulator.positions().rowwise().mean();
    if (way_.empty()) start_ = middle;
    way_.push_back(along_.dot(middle - start_));
    fastest_ = simulator.state().v.colwise().norm().maxCoeff();
  }
  [[nodiscard]] double way() const { return way_.back(); }
  [[nodiscard]] double way(std::size_t frame) const { return way_.at(frame); }
  [[nodiscard]] std::size_t last_frame() const { return way_.size() - 1; }
  [[nodiscard]] double fastest() const { return fastest_; }

 private:
  Vector3 along_;
  Vector3 start_ = Vector3::Zero();
  std::vector<double> way_;
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

TEST_P(ClothOnGround, SlidesIfAndOnlyIfItIsSteeperThanFrictionHolds) {
  for (const double factor : {0.99, 1.01}) {
    const Slope slope = slope_beyond(factor);
    Journey journey(Vector3::UnitX());
    const Vector3 gravity = kGravity * Vector3(std::sin(slope.angle), -std::cos(slope.angle), 0.0);
    const ScenarioReport report =
        run_scenario(scene({std::string("gravity=").append(json_text(gravity)), "duration=1"}), std::ref(journey));
    EXPECT_TRUE(report.is_free()) << report;
    // Verlet is exact for a constant acceleration; the tolerance is rounding's, of 240 steps on positions of size 1.
    EXPECT_NEAR(journey.way(), std::max(0.0, 0.5 * slope.acceleration()), 1e-10) << "steeper by " << factor;
  }
}

TEST_P(ClothOnGround, StopsAfterItsStoppingDistance) {
  Journey journey(Vector3::UnitX());
  const ScenarioReport report = run_scenario(scene({"bodies.cloth.velocity=[3,0,0]"}), std::ref(journey));
  EXPECT_TRUE(report.is_free()) << report;
  // Exact up to the step in which it stops: less than mu g dt^2.
  const double distance = 3.0 * 3.0 / (2.0 * kFriction * kGravity);
  EXPECT_NEAR(journey.way(), distance, kFriction * kGravity * report.step * report.step);
  EXPECT_EQ(journey.fastest(), 0.0);
}

class TurnedGround : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] static std::string ground(const Slope& slope) {
    std::string result = R"(obstacles.ground={"shape": {"type": "box", "size": [20, 1, 20]}, "friction": 0.3, "place": )";
    result.append(slope.place(-0.5 * kGroundDepth, 0.0)).append("}");
    return result;
  }
};
INSTANTIATE_TEST_SUITE_P(StepFactor, TurnedGround, ::testing::Values(1.0, 4.0));

TEST_P(TurnedGround, HoldsAClothIfAndOnlyIfFrictionDoes) {
  for (const double factor : {0.99, 1.01}) {
    const Slope slope = slope_beyond(factor);
    Journey journey(slope.down());
    const std::string place = std::string("bodies.cloth.place=").append(slope.place(0.005, -90.0));
    const ScenarioReport report =
        run_scenario(load_scenario("cloth_on_ground", {ground(slope), place, "duration=1"}, GetParam()), std::ref(journey));
    EXPECT_TRUE(report.is_free()) << report;
    EXPECT_NEAR(journey.way(), std::max(0.0, 0.5 * slope.acceleration()), 1e-10) << "steeper by " << factor;
  }
}

// A jelly's step is as long as its springs allow: there is none that is four times coarser, but one that is finer.
TEST_P(TurnedGround, SlowsAJellyDownIfAndOnlyIfFrictionHolds) {
  for (const double factor : {0.99, 1.01}) {
    const Slope slope = slope_beyond(factor);
    Journey journey(slope.down());
    const std::string place = std::string("bodies.jelly.place=").append(slope.place(0.105, 0.0));
    const ScenarioReport report =
        run_scenario(load_scenario("jelly_on_ground", {ground(slope), place}, GetParam() / 4.0), std::ref(journey));
    EXPECT_TRUE(report.is_free()) << report;
    // It begins undeformed, and until it has settled under its weight it slides further than a rigid block. From then on it is one:
    // the way in the last second but one less that in the last tells its acceleration.
    const std::size_t end = journey.last_frame();
    const double gained = journey.way(end) - 2.0 * journey.way(end - 60) + journey.way(end - 120);
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
