// The model that simulators share, and copies of simulators.
#include "simulation/model.h"

#include "base/error.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/forces/pull_force.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

namespace sprung {
namespace {

using testing::cloth;
using testing::ground;
using testing::kGravity;
using testing::run;

/// A cloth that hangs by two corners and tears, and a rope that comes to rest on the ground, far from the pieces.
SpringNetwork torn_and_resting() {
  SpringMaterial material{.value = 100.0, .damping = 1.0, .break_strain = 0.15};
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {9, 9}}, {.structural = material, .shear = material});
  set_total_mass(shape, 4.0);
  RigidTransform above = RigidTransform::Identity();
  above.translation() = Vector3(0.0, 4.0, 0.0);
  place(shape, above, Vector3::Zero());
  BodyShape rope = make_rope({.points = {{300.0, 0.005, 0.0}, {301.0, 0.005, 0.0}}, .particles = 8, .length = {}},
                             {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
  set_total_mass(rope, 0.1);
  NetworkBuilder builder;
  const Index first = builder.add_body("cloth", shape);
  builder.pin({first + 72, first + 80});
  builder.add_body("rope", rope, {.thickness = 0.005, .friction = 0.5, .static_friction = 0.5});
  return builder.build();
}

TEST(Model, IsBuiltOnceForARunThatTearsWakesPinsAndChangesGravity) {
  const BuildCounts before = Model::build_counts();
  Simulator simulator(torn_and_resting(), {.step = 1e-3}, {ground({.thickness = 0.005, .friction = 0.5, .static_friction = 0.5})});
  while (!testing::sleeps(simulator, 1) && simulator.time() < 20.0) simulator.step();
  ASSERT_TRUE(testing::sleeps(simulator, 1));
  EXPECT_GT(simulator.state().springs.broken_count(), 0);
  simulator.wake();
  EXPECT_FALSE(testing::sleeps(simulator, 1));
  simulator.pin(85);
  simulator.set_gravity(Vector3(1.0, -5.0, 0.0));
  run(simulator, 0.1);
  simulator.release(85);
  simulator.step();
  const BuildCounts after = Model::build_counts();
  EXPECT_EQ(after.models - before.models, 1);
  EXPECT_EQ(after.bounds - before.bounds, 1);
}

TEST(Model, ManySimulatorsShareOneInAnyThread) {
  const std::shared_ptr<const Model> model = Model::build(cloth(12, 0.3), {.step = 1e-3}, {ground()});
  std::array<Points, 4> ends;
  std::vector<std::thread> threads;
  for (Points& end : ends) {
    threads.emplace_back([&] {
      Simulator simulator(model);
      run(simulator, 0.4);
      end = simulator.positions();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Points& end : ends) EXPECT_EQ(end, ends[0]);
  Simulator alone(cloth(12, 0.3), {.step = 1e-3}, {ground()});
  run(alone, 0.4);
  EXPECT_EQ(alone.positions(), ends[0]);
}

TEST(Model, DoesNotChangeWithItsSimulators) {
  Simulator simulator(torn_and_resting(), {.step = 1e-3}, {ground()});
  const std::shared_ptr<const Model> model = simulator.model();
  const SimulationState start = model->initial_state();
  const Index springs = model->network().springs.count();
  run(simulator, 1.0);
  EXPECT_LT(simulator.network().springs.count(), springs);
  EXPECT_EQ(model->network().springs.count(), springs);
  EXPECT_EQ(model->initial_state(), start);
  Simulator again(model);
  EXPECT_EQ(again.state(), start);
}

TEST(Copy, GoesOnAsItsOriginalAndApartFromIt) {
  Simulator original(torn_and_resting(), {.step = 1e-3}, {ground()});
  run(original, 0.3);
  Simulator copy = original;
  EXPECT_EQ(copy.model(), original.model());
  EXPECT_EQ(copy.state(), original.state());
  copy.set_gravity(Vector3::Zero());
  run(copy, 0.05);
  EXPECT_EQ(original.settings().gravity, Vector3(0.0, -kGravity, 0.0));
  const Points before = original.positions();
  copy = original;
  EXPECT_EQ(copy.positions(), before);
  EXPECT_EQ(copy.settings().gravity, original.settings().gravity);
}

/// Scenes with contact: of a cloth with obstacles, of two cloths with each other, and of a rope with itself and the ground.
std::vector<Simulator> scenes_with_contact(const IntegratorSettings& integrator) {
  const ContactMaterial rough{.thickness = 0.01, .friction = 0.3};
  SimulatorSettings settings{.step = 1e-3, .integrator = integrator, .stretch_limit = StretchLimitSettings{.max_stretch = 0.1}};
  std::vector<Simulator> scenes;
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.3}, .material = rough};
  scenes.emplace_back(cloth(12, 0.35, rough), settings, std::vector{ground(rough), ball});
  NetworkBuilder cloths;
  for (const double height : {0.02, 0.1}) {
    BodyShape shape =
        make_cloth({.size = {1.0, 1.0}, .resolution = {8, 8}}, {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
    set_total_mass(shape, 0.2);
    RigidTransform pose = RigidTransform::Identity();
    pose.linear() = rotation_from_degrees({-90.0, 30.0 * height, 0.0});
    pose.translation().y() = height;
    place(shape, pose);
    cloths.add_body("cloth at " + std::to_string(height), shape, rough, {.others = true});
  }
  scenes.emplace_back(cloths.build(), settings, std::vector{ground(rough)});
  NetworkBuilder ropes;
  BodyShape rope = make_rope({.points = {{0.0, 0.05, 0.0}, {0.02, 0.6, 0.01}, {-0.02, 1.2, 0.0}}, .particles = 40},
                             {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
  set_total_mass(rope, 0.1);
  ropes.add_body("rope", rope, rough, {.self = true});
  scenes.emplace_back(ropes.build(), settings, std::vector{ground(rough)});
  return scenes;
}

TEST(Copy, AgreesBitByBitWithOtherCopiesAndWithARestoredOriginal) {
  for (const IntegratorSettings& integrator : {IntegratorSettings(VerletSettings()), IntegratorSettings(ImplicitEulerSettings())}) {
    for (Simulator& original : scenes_with_contact(integrator)) {
      run(original, 0.4);
      original.restore(original.state());
      Simulator first = original;
      Simulator second = original;
      Index contacts = 0;
      for (int k = 0; k < 200; ++k) {
        original.step();
        first.step();
        second.step();
        contacts += original.contact_count();
        ASSERT_EQ(first.state(), second.state()) << "step " << k;
        ASSERT_EQ(first.state(), original.state()) << "step " << k;
      }
      EXPECT_GT(contacts, 100);
    }
  }
}

// set_gravity() and set_air() decide until other settings come.
TEST(ContinueWith, ReplacesGravityAndWindThatWereSetBefore) {
  SimulatorSettings settings{.step = 1e-3, .air_drag = 0.1};
  Simulator simulator(cloth(5, 1.0), settings);
  simulator.set_gravity(Vector3(1.0, 0.0, 0.0));
  simulator.set_air(0.1, Wind(Vector3(2.0, 0.0, 0.0)));
  EXPECT_EQ(simulator.settings().gravity, Vector3(1.0, 0.0, 0.0));
  settings.gravity = Vector3(0.0, 0.0, 3.0);
  simulator.continue_with(simulator.model()->network(), settings);
  EXPECT_EQ(simulator.settings().gravity, settings.gravity);
  EXPECT_EQ(simulator.settings().wind.max_speed(), 0.0);
  simulator.set_air(0.2, Wind(Vector3(5.0, 0.0, 0.0)));
  EXPECT_EQ(simulator.settings().wind.max_speed(), 5.0);
  EXPECT_EQ(simulator.settings().gravity, settings.gravity);
}

TEST(Restore, BringsAFormerStateBack) {
  Simulator simulator(torn_and_resting(), {.step = 1e-3}, {ground()});
  run(simulator, 0.1);
  const SimulationState former = simulator.state();
  const double* const address = simulator.positions().data();
  run(simulator, 1.5);
  const SimulationState later = simulator.state();
  EXPECT_NE(later.springs.broken_count(), former.springs.broken_count());
  simulator.restore(former);
  EXPECT_EQ(simulator.state(), former);
  EXPECT_EQ(simulator.positions().data(), address) << "views of the positions last";
  EXPECT_EQ(simulator.network().springs.count(), simulator.model()->network().springs.count() - former.springs.broken_count());
}

TEST(Restore, DemandsTheForcesThatTheStateKnows) {
  Simulator simulator(cloth(5, 1.0), {.step = 1e-3});
  const SimulationState without = simulator.state();
  simulator.add_force(std::make_shared<PullForce>(simulator.network(), simulator.positions(), 0, 1e-3));
  try {
    simulator.restore(without);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("state.added_forces = 0: must be 1"));
  }
  simulator.step();
  EXPECT_NO_THROW(simulator.restore(simulator.state()));
}

TEST(AddedForce, KeepsOnlyWhatItTouchesAwake) {
  const ContactMaterial rough{.thickness = 0.005, .friction = 0.5, .static_friction = 0.5};
  const auto rope = [](double x) {
    BodyShape shape = make_rope({.points = {{x, 0.005, 0.0}, {x + 1.0, 0.005, 0.0}}, .particles = 8, .length = {}},
                                {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
    set_total_mass(shape, 0.1);
    return shape;
  };
  NetworkBuilder builder;
  builder.add_body("pulled", rope(0.0), rough);
  builder.add_body("left", rope(3.0), rough);
  Simulator simulator(builder.build(), {.step = 1e-3}, {ground(rough)});
  simulator.add_force(std::make_shared<PullForce>(simulator.network(), simulator.positions(), 0, 1e-3));
  run(simulator, 2.0);
  EXPECT_FALSE(testing::sleeps(simulator, 0));
  EXPECT_TRUE(testing::sleeps(simulator, 1));
}

TEST(State, AnyNumberThatDiffersMakesStatesDiffer) {
  Simulator simulator(torn_and_resting(), {.step = 1e-3, .record_forces = true, .record_contact_forces = true}, {ground()});
  run(simulator, 0.5);
  const SimulationState state = simulator.state();
  EXPECT_EQ(hash(state), hash(SimulationState(state)));
  const auto differs = [&](const auto& change) {
    SimulationState other = state;
    change(other);
    return !(other == state) && hash(other) != hash(state);
  };
  EXPECT_TRUE(differs([](SimulationState& s) { s.x(0, 0) = std::nextafter(s.x(0, 0), 1.0); }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.v(2, 3) += 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.x_previous(1, 1) += 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { ++s.step_in_frame; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.activity.pin_of[4] = 0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.activity.phases[0] = PinPhase::over; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.springs.broken[0] ^= 1; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.contact.pushed.push_back(1); }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.contact.slip.displacement(0, 0) = 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.rest.sleepers[0] ^= 1; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.energy.stored += 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.planner.retry_wait = 3; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.limit.handovers[1].missed_steps = 2; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.impulses.on_pinned(0, 0) += 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.impulses.of_contact(0, 0) += 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.reactions.since += 1.0; }));
  EXPECT_TRUE(differs([](SimulationState& s) { s.steering.obstacles.push_back({0, {{0.0, RigidTransform::Identity()}}}); }));
  EXPECT_FALSE(differs([](SimulationState&) {}));
}

/// Keeps particle 2 at height 0, and takes the momentum for it from particle 0, which a pin holds. Without a state of its own.
class Lever final : public Constraint {
 public:
  explicit Lever(double mass) : mass_(mass) {}
  double project(const Points& /*before*/, Points& positions, const ImpulseRecorder& recorder) const override {
    const double off = positions(1, 2);
    positions(1, 2) = 0.0;
    if (recorder.on()) recorder.add_to_pinned(0, Vector3(0.0, mass_ * off, 0.0));
    return std::abs(off) / 1.0e-12;
  }
  [[nodiscard]] double residual(const Points& positions) const override { return std::abs(positions(1, 2)) / 1.0e-12; }

 private:
  double mass_;  ///< of the particle [kg]
};

// Each records its own impulses.
TEST(Copy, SharesAConstraintWithItsOriginalInAnotherThread) {
  BodyShape shape = make_rope({.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, .particles = 3},
                              {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
  set_total_mass(shape, 0.3);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  builder.pin(0);
  Simulator original(builder.build(), {.step = 1e-3, .record_forces = true});
  original.add_constraint(std::make_shared<Lever>(original.network().masses[2]));
  run(original, 0.1);
  const Simulator start = original;
  const auto forces_of = [](Simulator simulator) {
    std::vector<Vector3> forces;
    for (int k = 0; k < 500; ++k) {
      simulator.step();
      for (const Reaction& reaction : simulator.reactions()) forces.push_back(reaction.force);
    }
    return forces;
  };
  const std::vector<Vector3> alone = forces_of(start);
  EXPECT_GT(std::abs(alone.back().y()), 0.0);
  std::array<std::vector<Vector3>, 4> together;
  std::vector<std::thread> threads;
  for (auto& forces : together) threads.emplace_back([&] { forces = forces_of(start); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& forces : together) EXPECT_EQ(forces, alone);
}

}  // namespace
}  // namespace sprung
