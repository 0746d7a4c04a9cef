// Cloths and ropes that the stretch limit alone carries, at any resolution.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace sprung::testing {
namespace {

const char* const kLevel = "bodies.cloth.place.rotation=[-90,0,0]";

/// The largest stretch of a structural spring in any frame.
double stretch(const std::string& name, const std::vector<std::string>& overrides) {
  return run_scenario(load_scenario(name, overrides), {}, Judge::nothing).max_stretch;
}

double stretch_of_cloth(int side, std::vector<std::string> overrides) {
  const std::string n = std::to_string(side);
  overrides.push_back(std::string("bodies.cloth.shape.resolution=[").append(n).append(",").append(n).append("]"));
  return stretch("limited_cloth", overrides);
}

double stretch_of_rope(int particles, std::vector<std::string> overrides) {
  overrides.push_back("bodies.rope.shape.particles=" + std::to_string(particles));
  return stretch("limited_rope", overrides);
}

TEST(Stretch, HangingClothsOfAnyResolutionKeepTheirLimit) {
  EXPECT_LT(stretch_of_cloth(64, {}), 0.01);
  EXPECT_LT(stretch_of_cloth(128, {"duration=1"}), 0.02);
  EXPECT_LT(stretch_of_cloth(256, {"duration=0.25"}), 0.02);
}

TEST(Stretch, SwingingClothsOfAnyResolutionKeepTheirLimit) {
  EXPECT_LT(stretch_of_cloth(64, {kLevel, "duration=1.5"}), 0.02);
  EXPECT_LT(stretch_of_cloth(128, {kLevel, "duration=0.5"}), 0.02);
}

TEST(Stretch, PassesKeepTheLimitOfAHangingClothToo) {
  EXPECT_LT(stretch_of_cloth(64, {R"(stretch_limit={"max_stretch": 0, "max_compression": 0, "kinds": ["structural", "shear"],
                                     "iterations": 1, "tolerance": 0.01, "tethers": true, "solver": "gauss_seidel"})"}),
            0.02);
}

TEST(Stretch, RopesKeepTheirLimit) {
  const std::string level = "bodies.rope.shape.points=[[0, 0, 0], [1, 0, 0]]";
  EXPECT_LT(stretch_of_rope(1000, {}), 0.005);
  EXPECT_LT(stretch_of_rope(1000, {level}), 0.005);
  EXPECT_LT(stretch_of_rope(100000, {"duration=1"}), 0.005);
  EXPECT_LT(stretch_of_rope(100000, {level, "duration=0.5"}), 0.01);
}

/// The potential energy [J] of a rope that is let go along a polyline, at the end of each frame of half a second.
std::vector<double> energies_of_fall(int particles, const std::string& points) {
  std::vector<double> energies;
  const std::string shape = R"(bodies.rope.shape={"type":"rope","points":)" + points + R"(,"particles":)";
  run_scenario(
      load_scenario("limited_rope",
                    {shape + std::to_string(particles) + "}", "duration=0.5", R"(stretch_limit={"max_stretch": 0.02})"}),
      [&](const Simulator&, const FrameDiagnostics& frame) { energies.push_back(frame.gravity_energy); }, Judge::nothing);
  return energies;
}

// Ropes of 100 and of 5,000 particles that move by up to 500 links in a step. A bend is as sharp as a link is long: of 100, a
// hundredth of the rope is elsewhere, and so is a hundredth of the energy of its fall by 1 m.
TEST(Stretch, RopesOfAnyResolutionFallAlike) {
  for (const char* const points : {"[[0,0,0],[1,0,0]]", "[[0,0,0],[0.5,0.3,0],[0.5,0,0.3],[1,0,0]]",
                                   "[[0,0,0],[0,-0.5,0],[0.05,-0.5,0],[0.05,0,0]]", "[[0,0,0],[0.01,1,0]]"}) {
    const std::vector<double> coarse = energies_of_fall(100, points);
    const std::vector<double> fine = energies_of_fall(5000, points);
    constexpr double kOfOneMetre = 0.1 * 9.81;
    for (std::size_t f = 0; f < fine.size(); ++f) EXPECT_NEAR(fine[f], coarse[f], 0.02 * kOfOneMetre) << points << ", frame " << f;
  }
}

class StretchOfADrape : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Obstacle, StretchOfADrape,
                         ::testing::Values(R"({"type": "sphere", "radius": 0.4})", R"({"type": "mesh", "file": "bunny.obj"})"));

TEST_P(StretchOfADrape, IsAtMostThreePerCentAndNothingCrosses) {
  const std::vector<std::string> overrides = {std::string("obstacles.bunny.shape=").append(GetParam()),
                                              "bodies.cloth.shape.resolution=[32,32]", "stretch_limit.max_stretch=0.01"};
  const ScenarioReport report = run_scenario(load_scenario("drape", overrides));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
  EXPECT_LT(report.max_stretch, 0.03) << report;
}

}  // namespace
}  // namespace sprung::testing
