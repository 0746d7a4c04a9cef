// What a simulator takes of a state that a program gives back.
#include "base/error.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using testing::deforming_sheet;
using testing::ground;
using ::testing::HasSubstr;
using testing::run;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// A particle on the ground, which a rod holds to a deforming sheet that pulls another particle.
class Resume : public ::testing::Test {
 protected:
  Resume() {
    obstacles_[1].rest_pose.translation() = Vector3(4.0, 0.5, 0.0);
    NetworkBuilder builder;
    builder.add_particle({0.0, 0.001, 0.0}, 0.1);
    builder.add_particle({1.0, 1.0, 0.0}, 0.1);
    builder.add_spring(0, 1, 10.0, 1.4, 0.1);
    Pin pin;
    pin.name = "hand";
    pin.particles = {1};
    pin.obstacle = 1;
    builder.add_pin(pin);
    network_ = builder.build();
    network_.attachments.push_back({.name = "rod", .particles = {0}, .second = ObstacleEnd{1}});
    simulator_ = std::make_unique<Simulator>(network_, settings_, obstacles_);
    run(*simulator_, 0.6);  // rest is judged after windows of 0.25 s
  }

  [[nodiscard]] Simulator resume(const SimulationState& state) const {
    Simulator resumed(network_, settings_, obstacles_);
    resumed.restore(state);
    return resumed;
  }

  SimulatorSettings settings_{.step = 2e-3, .record_forces = true, .record_contact_forces = true};
  SpringNetwork network_;
  std::vector<Obstacle> obstacles_{ground(), deforming_sheet(0.9 * Matrix3::Identity())};
  std::unique_ptr<Simulator> simulator_;
};

/// A state with a pin that a program added, but for one fault.
std::function<void(SimulationState&)> pinned(const std::function<void(Pin&)>& spoil) {
  return [spoil](SimulationState& state) {
    Pin& pin = state.steering.added_pins.emplace_back();
    pin.name = "finger";
    pin.particles = {0};
    spoil(pin);
    state.activity.phases.push_back(PinPhase::holding);
    state.activity.pin_of[0] = 1;
  };
}

TEST_F(Resume, TakesAPinThatAProgramAdded) {
  SimulationState state = simulator_->state();
  pinned([](Pin&) {})(state);
  Simulator resumed = resume(state);
  resumed.step();
  EXPECT_TRUE(resumed.network().is_pinned(0));
}

TEST_F(Resume, RefusesAStateThatDoesNotFit) {
  const std::vector<std::pair<std::string, std::function<void(SimulationState&)>>> faults{
      {"state.x = 0 entries: must have 2 entries", [](SimulationState& state) { state = {}; }},
      {"state.x: must be finite", [](SimulationState& state) { state.x(1, 0) = kNotANumber; }},
      {"state.v: must be finite", [](SimulationState& state) { state.v(1, 0) = kNotANumber; }},
      {"state.x_previous = 3 entries", [](SimulationState& state) { state.x_previous.setZero(3, 3); }},
      {"state.frame = -1", [](SimulationState& state) { state.frame = -1; }},
      {"state.step_length = 0.5", [](SimulationState& state) { state.step_length = 0.5; }},
      {"state.integrator = RungeKutta4Settings", [](SimulationState& state) { state.integrator = 4; }},
      {"state.steps_per_frame = 7", [](SimulationState& state) { state.steps_per_frame = 7; }},
      {"state.step_in_frame = 1", [](SimulationState& state) { state.step_in_frame = 1; }},
      {"state.substeps = 0", [](SimulationState& state) { state.substeps = 0; }},
      {"state.substep = 3", [](SimulationState& state) { state.substep = 3; }},
      {"state.energy = nan", [](SimulationState& state) { state.energy.stored = kNotANumber; }},
      {"state.limit.handovers = 0 entries", [](SimulationState& state) { state.limit.handovers.clear(); }},
      {"state.limit.handovers[0]", [](SimulationState& state) { state.limit.handovers[0].missed_steps = 3; }},
      {"state.substeps = 2", [](SimulationState& state) { state.substeps = 2; }},
      {"state.activity.phases = 0 entries", [](SimulationState& state) { state.activity.phases.clear(); }},
      {"state.activity.pin_of = 1 entries", [](SimulationState& state) { state.activity.pin_of.resize(1); }},
      {"state.activity.pin_of[0] = 1", [](SimulationState& state) { state.activity.pin_of[0] = 1; }},
      {"state.activity.asleep = 3 entries", [](SimulationState& state) { state.activity.asleep.resize(3); }},
      {"state.springs.rest_lengths = 1 entries", [](SimulationState& state) { state.springs.rest_lengths = {1.0}; }},
      {"state.springs.broken = 1 entries", [](SimulationState& state) { state.springs.broken = {1}; }},
      {"state.contact.slip.obstacle[0] = 2", [](SimulationState& state) { state.contact.slip.obstacle[0] = 2; }},
      {"state.contact.pushed[0] = 2", [](SimulationState& state) { state.contact.pushed = {2}; }},
      {"state.contact.normals[0]",
       [](SimulationState& state) {
         state.contact.normals = {{2, Vector3::UnitY()}};
       }},
      {"state.contact.permitted_crossings[0]",
       [](SimulationState& state) {
         state.contact.permitted_crossings = {{2, 0}};
       }},
      {"state.rest.sleepers = 9 entries", [](SimulationState& state) { state.rest.sleepers.assign(9, 0); }},
      {"state.rest.histories = 1 entries", [](SimulationState& state) { state.rest.histories.resize(1); }},
      {"state.rest.x_at_frame = 1 entries", [](SimulationState& state) { state.rest.x_at_frame.setZero(3, 1); }},
      {"state.springs.unloading = 1 entries", [](SimulationState& state) { state.springs.unloading.resize(1); }},
      {"state.springs.unloading",
       [](SimulationState& state) {
         state.springs.unloading.resize(static_cast<std::size_t>(state.x.cols()));
         state.springs.unloading.back().by_recoil = std::numeric_limits<double>::infinity();
       }},
      {"state.grips[0]", [](SimulationState& state) { state.grips.at(0).particle = 2; }},
      {"state.grips.hand.triangle = 2", [](SimulationState& state) { state.grips.at(0).triangle = 2; }},
      {"state.links[0]", [](SimulationState& state) { state.links.at(0).triangle = 2; }},
      {"state.links[0]", [](SimulationState& state) { state.links.at(0).attachment = 1; }},
      {"state.links[0]", [](SimulationState& state) { state.links.at(0).second[0] = 2; }},
      {"state.impulses.on_pinned = 1 entries", [](SimulationState& state) { state.impulses.on_pinned.setZero(3, 1); }},
      {"state.impulses.of_contact = 1 entries", [](SimulationState& state) { state.impulses.of_contact.setZero(3, 1); }},
      {"state.impulses.of_contact", [](SimulationState& state) { state.impulses.of_contact(0, 0) = kNotANumber; }},
      {"state.last_impulses: must be there if", [](SimulationState& state) { state.last_impulses.of_contact = Points(3, 0); }},
      {"state.last_impulses: must be there if", [](SimulationState& state) { state.last_impulses = {}; }},
      {"state.last_impulses: must be there if", [](SimulationState& state) { state.impulses = {}; }},
      {"state.impulses.of_springs: must be finite", [](SimulationState& state) { state.impulses.of_springs[0] = kNotANumber; }},
      {"state.reactions.impulses: must be finite",
       [](SimulationState& state) { state.reactions.impulses["hand"] = Vector3::Constant(kNotANumber); }},
      {"state.reactions.since = nan", [](SimulationState& state) { state.reactions.since = kNotANumber; }},
      {"state.step = 9007199254740993", [](SimulationState& state) { state.step = (std::int64_t{1} << 53) + 1; }},
      {"state.frame = 9223372036854775807", [](SimulationState& state) { state.frame = std::numeric_limits<std::int64_t>::max(); }},
      {"state.limit.handovers[0]", [](SimulationState& state) { state.limit.handovers[0].missed_steps = -1; }},
      {"state.activity.phases", [](SimulationState& state) { state.activity.phases[0] = static_cast<PinPhase>(77); }},
      {"state.grips: must be sorted by particle, one for each",
       [](SimulationState& state) { state.grips.push_back(state.grips.at(0)); }},
      {"state.links: must be one for each", [](SimulationState& state) { state.links.push_back(state.links.at(0)); }},
      {"state.steering.added_pins = finger", pinned([](Pin& pin) { pin.obstacle = 7; })},
      {"state.steering.added_pins = finger", pinned([](Pin& pin) { pin.motion.spin = Vector3::UnitX(); })},
      {"state.steering.added_pins = finger", pinned([](Pin& pin) { pin.until = 10.0; })},
      {"state.steering.added_pins = finger", pinned([](Pin& pin) { pin.origin.x() = kNotANumber; })},
      {"state.steering.added_pins = hand", pinned([](Pin& pin) { pin.name = "hand"; })},
      {"state.steering.added_pins: must have a name", pinned([](Pin& pin) { pin.name.clear(); })},
      {"state.last_impulses.of_springs = 9 entries", [](SimulationState& state) { state.last_impulses.of_springs.setZero(9); }},
  };
  for (const auto& [problem, spoil] : faults) {
    SimulationState state = simulator_->state();
    spoil(state);
    try {
      (void)resume(state);
      ADD_FAILURE() << "took a state with the fault " << problem;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(problem));
    }
  }
}

TEST_F(Resume, KeepsTheIntervalOfForces) {
  Simulator resumed = resume(simulator_->state());
  for (int step = 0; step < 10; ++step) {
    simulator_->step();
    resumed.step();
  }
  const std::vector<Reaction> expected = simulator_->reactions();
  const std::vector<Reaction> reactions = resumed.reactions();
  ASSERT_EQ(reactions.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_GT(expected[k].force.norm(), 0.0) << expected[k].name;
    EXPECT_LT((reactions[k].force - expected[k].force).norm(), 1e-9 * expected[k].force.norm()) << expected[k].name;
  }
}

TEST_F(Resume, RecordsAsItsSettingsSay) {
  settings_.record_forces = false;
  Simulator silent = resume(simulator_->state());
  silent.step();
  EXPECT_TRUE(silent.reactions().empty());
  const SimulationState without = silent.state();
  settings_.record_forces = true;
  Simulator recording = resume(without);
  recording.step();
  EXPECT_EQ(recording.reactions().size(), 2U);
  settings_.record_contact_forces = false;
  Simulator blind = resume(recording.state());
  blind.step();
  EXPECT_TRUE(blind.contact_forces().isZero(0.0));
  EXPECT_EQ(blind.reactions().size(), 2U);
}

// A pin pulls a rod through a plate that holds back the rod's other end. The crossing is permitted from then on; a run that forgot
// it would count the rod as infeasible again.
TEST(ResumedCrossing, StaysPermitted) {
  NetworkBuilder builder = testing::rod();
  builder.pin(0, {.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, 1.0, 0.0}}}});
  Obstacle plate{.name = "plate", .geometry = BoxGeometry{.size = {2.0, 0.02, 2.0}}};
  plate.rest_pose.translation() = Vector3(0.0, 0.3, 0.0);
  const SimulatorSettings settings{.step = 1e-2};
  Simulator simulator(builder.build(), settings, {plate});
  for (int step = 0; step < 100 && simulator.state().contact.permitted_crossings.empty(); ++step) simulator.step();
  ASSERT_FALSE(simulator.state().contact.permitted_crossings.empty());
  Simulator resumed(builder.build(), settings, {plate});
  resumed.restore(simulator.state());
  for (int step = 0; step < 10; ++step) {
    EXPECT_EQ(resumed.step().infeasible, simulator.step().infeasible) << step;
    EXPECT_EQ(resumed.positions(), simulator.positions()) << step;
  }
}

}  // namespace
}  // namespace sprung
