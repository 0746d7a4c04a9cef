// Bodies on the ground come to rest and stay at rest: they do not jitter and gain no energy.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace sprung::testing {
namespace {

constexpr double kThickness = 0.005;  // [m] of the scenes

const char* const kGrounds[] = {
    R"(obstacles.ground={"shape": {"type": "half_space"}, "friction": 0.3})",
    R"(obstacles.ground={"shape": {"type": "box", "size": [4, 1, 4]}, "place": {"position": [0, -0.5, 0]}, "friction": 0.3})",
    R"(obstacles.ground={"shape": {"type": "mesh", "file": "thin_sheet.obj"}, "place": {"scale": 4}, "friction": 0.3})",
};

/// Extremes since a time [s].
class Extremes {
 public:
  explicit Extremes(double since) : since_(since) {}

  void operator()(const Simulator& simulator, const FrameDiagnostics& frame) {
    const double energy = frame.kinetic_energy + frame.elastic_energy + frame.gravity_energy;
    if (frame.frame > 1) energy_growth_ = std::max(energy_growth_, energy - least_energy_);
    least_energy_ = std::min(least_energy_, energy);
    if (frame.time < since_) return;
    lowest_ = std::min(lowest_, simulator.positions().row(1).minCoeff());
    highest_ = std::max(highest_, simulator.positions().row(1).maxCoeff());
    fastest_ = std::max(fastest_, simulator.state().v.colwise().norm().maxCoeff());
  }

  [[nodiscard]] double lowest() const { return lowest_; }
  [[nodiscard]] double highest() const { return highest_; }
  [[nodiscard]] double fastest() const { return fastest_; }
  /// The largest rise of the energy [J] above its lowest earlier value, over the whole run.
  [[nodiscard]] double energy_growth() const { return energy_growth_; }

 private:
  double since_;
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
  double fastest_ = 0.0;
  double least_energy_ = std::numeric_limits<double>::infinity();
  double energy_growth_ = 0.0;
};

class Rest : public ::testing::TestWithParam<std::tuple<const char*, double>> {
 protected:
  [[nodiscard]] static BuiltScene scene(std::vector<std::string> overrides) {
    const auto& [ground, step_factor] = GetParam();
    overrides.emplace_back(ground);
    return load_scenario("cloth_on_ground", overrides, step_factor);
  }
};
INSTANTIATE_TEST_SUITE_P(StepFactor, Rest, ::testing::Combine(::testing::ValuesIn(kGrounds), ::testing::Values(1.0, 4.0)));

TEST_P(Rest, AClothThatLiesAtItsThicknessDoesNotMove) {
  Extremes extremes(0.0);
  const ScenarioReport report = run_scenario(scene({"duration=5"}), std::ref(extremes));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_NEAR(extremes.lowest(), kThickness, 1e-9 * kThickness);
  EXPECT_NEAR(extremes.highest(), kThickness, 1e-9 * kThickness);
  EXPECT_LT(extremes.fastest(), 1e-9);
  EXPECT_LT(extremes.energy_growth(), 1e-15);
}

TEST_P(Rest, AClothThatFellAskewComesToRestAtItsThickness) {
  Extremes extremes(4.0);
  const ScenarioReport report = run_scenario(
      scene({"duration=5", R"(bodies.cloth.place={"position": [0, 0.25, 0], "rotation": [-50, 10, 0]})"}), std::ref(extremes));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_NEAR(extremes.lowest(), kThickness, 0.05 * kThickness);
  EXPECT_NEAR(extremes.highest(), kThickness, 0.05 * kThickness);
  EXPECT_LT(extremes.fastest(), 1e-3);
  // The fall released 0.3 J.
  EXPECT_LT(extremes.energy_growth(), 1e-12);
}

// The upper cloth starts at rest, so its velocity does not announce the contact; only its fall in the step does.
TEST(RestOfAPile, AClothDroppedOntoAnotherStaysOneGapAboveIt) {
  for (const double step_factor : {0.25, 1.0, 4.0}) {
    for (const double height : {0.012, 0.02, 0.04}) {
      const std::string upper =
          R"(bodies.upper={"shape": {"type": "cloth", "size": [0.31, 0.31], "resolution": [7, 7]}, "mass": 0.1,
          "springs": {"structural": {"stiffness": 0}, "shear": {"stiffness": 0}}, "thickness": 0.005,
          "place": {"rotation": [-90, 0, 0], "position": [0.01, )" +
          std::to_string(height) + ", 0.02]}}";
      Extremes all(0.0);
      double nearest = std::numeric_limits<double>::infinity();
      double farthest = 0.0;
      const auto watch = [&](const Simulator& simulator, const FrameDiagnostics& frame) {
        all(simulator, frame);
        const Index lower = simulator.network().bodies.front().particle_count;
        const Points& x = simulator.positions();
        nearest = std::min(nearest, x.row(1).tail(x.cols() - lower).minCoeff() - x.row(1).head(lower).maxCoeff());
        farthest = x.row(1).tail(x.cols() - lower).maxCoeff() - x.row(1).head(lower).minCoeff();
      };
      const BuiltScene scene = load_scenario("cloth_on_ground", {"duration=1", upper}, step_factor);
      const ScenarioReport report = run_scenario(scene, watch, Judge::obstacles_and_self);
      EXPECT_TRUE(report.is_free()) << report;
      EXPECT_GT(nearest, 0.95 * kThickness) << height << " m at " << step_factor;
      EXPECT_LT(farthest, 1.05 * kThickness) << height << " m at " << step_factor;
      // Passes end when they move no particle by more than a thousandth of the gap. They may lift both cloths by that height.
      EXPECT_LT(all.energy_growth(), 0.2 * 9.81 * 1e-3 * kThickness) << height << " m at " << step_factor;
    }
  }
}

TEST(RestOfAJelly, ItRestsAtItsThickness) {
  for (const double step_factor : {0.25, 1.0}) {
    Extremes extremes(2.5);
    const ScenarioReport report = run_scenario(load_scenario("jelly_on_ground", {}, step_factor), std::ref(extremes));
    EXPECT_TRUE(report.is_free()) << report;
    EXPECT_NEAR(extremes.lowest(), kThickness, 0.05 * kThickness);
    EXPECT_LT(extremes.fastest(), 1e-3);
    // Verlet's velocity is half a step old. The jelly oscillates four times a second, at first with 0.03 J. In half a step,
    // 1 / 1080 s, a fraction of 26 / 1080 = 0.024 of that moves between kinetic and elastic energy. Friction gives back the slip of
    // a step, mu g dt^2, with a tenth of its force, mu m g.
    const double slip = 0.3 * 9.81 / (540.0 * 540.0);
    EXPECT_LT(extremes.energy_growth(), 0.024 * 0.03 + 0.5 * 0.1 * (0.3 * 8.0 * 9.81) * slip);
  }
}

// Passes find the load of a step only roughly. Friction that forgot what particles slipped under too large a load let this cloth
// creep off the bunny: particles that touched it moved by 4 mm each second, half of those that do now by 0.01 mm. In a step,
// friction moves a particle that carries its own weight by at most mu g dt^2, 68 um: a particle that stays where it stuck wanders
// by no more.
TEST(RestOfADrape, ALimpClothStaysWhereItStuckToABunny) {
  const BuiltScene scene = load_scenario("drape", {"duration=7", "bodies.cloth.shape.resolution=[32,32]",
                                                   "bodies.cloth.self_contact=false", "stretch_limit={\"max_stretch\": 0.02}"});
  Points at_six;
  std::vector<double> moved;
  run_scenario(
      scene,
      [&](const Simulator& simulator, const FrameDiagnostics& frame) {
        if (frame.frame == 180) at_six = simulator.positions();
        if (frame.frame != 210) return;
        for (const Index i : simulator.contact_particles()) moved.push_back((simulator.positions().col(i) - at_six.col(i)).norm());
      },
      Judge::nothing);
  std::sort(moved.begin(), moved.end());
  ASSERT_GT(moved.size(), 100u);
  // One in four lies near a fold that still settles.
  EXPECT_LT(moved[moved.size() * 3 / 4], 0.4 * 9.81 * scene.settings.step * scene.settings.step);
}

TEST(RestOfADrape, ALimpClothAtRestOnABunnyCostsNothing) {
  std::int64_t substeps = 1;
  run_scenario(
      load_scenario("drape", {"duration=14", "bodies.cloth.shape.resolution=[32,32]", "bodies.cloth.self_contact=false",
                              "stretch_limit={\"max_stretch\": 0.02}", "sleep=true"}),
      [&](const Simulator&, const FrameDiagnostics& frame) { substeps = frame.substeps; }, Judge::nothing);
  EXPECT_EQ(substeps, 0);
}

// Both stand on their ends at first, off their plane or line by the tiny push alone, and are slower than what rests for seconds.
TEST(RestOfWhatStands, AStiffClothAndASteelRopeFallOverBeforeTheySleep) {
  const std::string board = R"(bodies={"board": {"shape": {"type": "cloth", "size": [0.4, 1.6], "resolution": [3, 9]}, "mass": 1,
      "springs": {"structural": {"stiffness": 4000, "damping": 1}, "shear": {"stiffness": 2000, "damping": 1},
                  "bend": {"model": "angle", "stiffness": 50, "damping": 0.5}},
      "place": {"position": [0, 0.805, 0]}, "thickness": 0.005, "friction": 0.8}})";
  const std::string rope = R"(bodies={"rope": {"shape": {"type": "rope", "from": [0, 0.01, 0], "to": [0, 0.11, 0], "particles": 6},
      "material": "steel_cable"}})";
  for (const std::string& bodies : {board, rope}) {
    double highest = 0.0;
    BuiltScene scene = load_scenario("cloth_on_ground", {bodies, "duration=9", "sleep=true", "integrator={\"type\": \"verlet\"}"});
    scene.settings.stretch_limit.reset();
    run_scenario(
        std::move(scene),
        [&](const Simulator& simulator, const FrameDiagnostics&) { highest = simulator.positions().row(1).maxCoeff(); },
        Judge::nothing);
    EXPECT_LT(highest, 0.02) << bodies;
  }
}

}  // namespace
}  // namespace sprung::testing
