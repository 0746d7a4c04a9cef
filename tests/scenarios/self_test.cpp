// Contact of networks with themselves and with each other.
#include "base/format.h"
#include "scenarios/judge.h"
#include "scenarios/knot.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

class SelfContact : public ::testing::TestWithParam<double> {
 protected:
  static ScenarioReport run(const std::string& name, const std::vector<std::string>& overrides = {}, const Watch& watch = {}) {
    return run_scenario(load_scenario(name, overrides, GetParam()), watch, Judge::obstacles_and_self);
  }
};
INSTANTIATE_TEST_SUITE_P(StepFactor, SelfContact, ::testing::Values(1.0, 4.0));

TEST_P(SelfContact, AClothTwistedTwoTurnsDoesNotCrossItself) {
  const ScenarioReport report = run("twisted_cloth");
  EXPECT_TRUE(report.is_free()) << report;
}

TEST_P(SelfContact, AClothSwungTwoTurnsByItsUpperCornersDoesNotCrossItself) {
  const ScenarioReport report = run("twisted_cloth", {R"(bodies.cloth.pins=[{"at": "corner", "which": ["min_max", "max_max"],
                                "motion": {"keyframes": [{"time": 0}, {"time": 2, "rotation": [0, 720, 0]}]}}])"});
  EXPECT_TRUE(report.is_free()) << report;
}

/// An override that moves the lower edge of a sheet around the axis between both sheets, at 300 degrees a second and in chords.
std::string around_axis(const std::string& body, double distance) {
  constexpr int kChords = 96;
  std::string keys;
  for (int k = 0; k <= kChords; ++k) {
    const double time = 0.3 * k / kChords;
    const double degrees = 300.0 * time;
    const double angle = degrees * std::numbers::pi / 180.0;
    keys += keys.empty() ? "" : ", ";
    keys += "{\"time\": " + format_number(time) + ", \"position\": [" + format_number(distance * std::sin(angle)) + ", 0, " +
            format_number(distance * (std::cos(angle) - 1.0)) + "], \"rotation\": [0, " + format_number(degrees) + ", 0]}";
  }
  return "bodies." + body + ".pins[1].motion={\"keyframes\": [" + keys + "]}";
}

// The pins of both sheets have the same motion except for the chords, so no pin drives elements through each other.
TEST(SelfContactAtPins, TwoSheetsTurnedTogetherStayFeasible) {
  BuiltScene scene = load_scenario("two_sheets_turned", {around_axis("front", 0.025), around_axis("back", -0.025)});
  const ScenarioReport report = run_scenario(std::move(scene), {}, Judge::obstacles_and_self);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

// 2.8 turns twist the cloth into a rope.
TEST(SelfContactAtPins, AClothTwistedAtBothEndsDoesNotCrossItself) {
  const ScenarioReport report = run_scenario(load_scenario("cloth_twisted_at_both_ends", {}), {}, Judge::obstacles_and_self);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

// Without a thickness nothing keeps gaps open, and the pins of both ends pull on the whole cloth at once.
TEST(SelfContactAtPins, AThinClothTwistedAtBothEndsDoesNotCrossItself) {
  const ScenarioReport report =
      run_scenario(load_scenario("cloth_twisted_at_both_ends", {"bodies.cloth.thickness=0"}), {}, Judge::obstacles_and_self);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

// An edge between two pins is driven through a triangle with two other pins and one free particle.
TEST(SelfContactAtPins, PinsThatDriveElementsThroughEachOtherAreReported) {
  const ScenarioReport report = run_scenario(load_scenario("pins_through_each_other", {}), {}, Judge::obstacles_and_self);
  EXPECT_FALSE(report.is_free());
  EXPECT_GT(report.infeasible, 0);
}

/// Expects that the centres of five cloths of n x n particles lie above the ball in their initial order.
void expect_a_pile(Index n, double step_factor) {
  const Watch watch = [n](const Simulator& simulator, const FrameDiagnostics& frame) {
    if (frame.frame % 30 != 1) return;
    double below = -std::numeric_limits<double>::infinity();
    for (const Body& body : simulator.network().bodies) {
      const double middle = simulator.positions()(1, body.first_particle + n / 2 * n + n / 2);
      EXPECT_GT(middle, below) << body.name << " in frame " << frame.frame;
      below = middle;
    }
  };
  std::vector<std::string> overrides;
  const std::string side = std::to_string(n);
  for (const char* name : {"first", "second", "third", "fourth", "fifth"}) {
    std::string text = "bodies.";
    overrides.push_back(text.append(name).append(".shape.resolution=[").append(side).append(",").append(side).append("]"));
  }
  const ScenarioReport report =
      run_scenario(load_scenario("stacked_cloths", overrides, step_factor), watch, Judge::obstacles_and_self);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

TEST(SelfContactOfAPile, FiveClothsLieOnABallInOrder) { expect_a_pile(20, 1.0); }

// In such steps cloths would move far past each other, which makes many pairs: finer cloths take too long.
TEST(SelfContactOfAPile, FiveClothsLieOnABallInOrderAtAStepFourTimesCoarser) { expect_a_pile(10, 4.0); }

/// The least distance [m] between segments of a rope that are at least `apart` segments away from each other along the rope.
double least_distance_between_segments(const Points& rope, Index apart) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i + 1 < rope.cols(); ++i) {
    for (Index k = i + apart; k + 1 < rope.cols(); ++k) least = std::min(least, segment_distance(rope, {i, i + 1}, {k, k + 1}));
  }
  return least;
}

TEST_P(SelfContact, AnOverhandKnotPulledTightStaysAKnot) {
  constexpr double kThickness = 0.008;  // [m] of the rope
  double least = std::numeric_limits<double>::infinity();
  const ScenarioReport report = run("overhand_knot", {}, [&](const Simulator& simulator, const FrameDiagnostics& frame) {
    ASSERT_EQ(knot_determinant(closed_far_away(simulator.positions())), 3) << "frame " << frame.frame;
    least = std::min(least, least_distance_between_segments(simulator.positions(), 4));
  });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(least, 0.5 * kThickness);
}

TEST_P(SelfContact, ClaspedRopesHoldEachOther) {
  double lower = 0.0;
  double upper = 0.0;
  const ScenarioReport report = run("clasped_ropes", {}, [&](const Simulator& simulator, const FrameDiagnostics&) {
    lower = simulator.positions().row(1).head(60).maxCoeff();
    upper = simulator.positions().row(1).tail(60).minCoeff();
  });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(lower, upper + 0.5 * 0.01);
}

class SelfContactOfAJelly : public ::testing::TestWithParam<double> {
 protected:
  static ScenarioReport run(const std::string& name, const Watch& watch) {
    return run_scenario(load_stiff_scenario(name, GetParam()), watch, Judge::obstacles_and_self);
  }
};
INSTANTIATE_TEST_SUITE_P(StepFactor, SelfContactOfAJelly, ::testing::Values(0.25, 1.0, 4.0));

TEST_P(SelfContactOfAJelly, AClothPinnedAtItsCornersCatchesIt) {
  double lowest = 0.0;
  const ScenarioReport report = run("jelly_on_cloth", [&](const Simulator& simulator, const FrameDiagnostics&) {
    const Body& jelly = simulator.network().bodies.back();
    lowest = simulator.positions().row(1).segment(jelly.first_particle, jelly.particle_count).minCoeff();
  });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_GT(lowest, -0.5);
}

Eigen::AlignedBox3d box_around(const Simulator& simulator, const Body& body) {
  const auto particles = simulator.positions().middleCols(body.first_particle, body.particle_count);
  return {particles.rowwise().minCoeff(), particles.rowwise().maxCoeff()};
}

TEST_P(SelfContactOfAJelly, AClothWrapsIt) {
  Eigen::AlignedBox3d cloth;
  Eigen::AlignedBox3d jelly;
  const ScenarioReport report = run("wrapped_jelly", [&](const Simulator& simulator, const FrameDiagnostics&) {
    cloth = box_around(simulator, simulator.network().bodies.front());
    jelly = box_around(simulator, simulator.network().bodies.back());
  });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
  EXPECT_TRUE(cloth.contains(jelly)) << "at the end, when the corners of the cloth are drawn together above the jelly";
}

}  // namespace
}  // namespace sprung::testing
