// Changes between two steps that a simulator refuses.
#include "dynamics/constraints/constraint.h"
#include "dynamics/forces/force.h"
#include "simulation/model.h"
#include "simulation/steered.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using namespace testing;
using ::testing::HasSubstr;

TEST(MoveObstacle, GoesNoFartherInAStepThanTheLargestBodyIsLarge) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.0, -0.5, 0.0}), low_ground()});
  EXPECT_EQ(
      refusal([&] {
        simulator.move_obstacle(0, pose_at({2.5, -0.5, 0.0}));
      }),
      "obstacles.ball.pose = 2.5 m from the present pose: must be at most 1 m away in one step, the size of the largest body; "
      "go there in 3 steps");
  for (int k = 1; k <= 3; ++k) {
    simulator.move_obstacle(0, pose_at({2.5 * k / 3.0, -0.5, 0.0}));
    simulator.step();
  }
  EXPECT_EQ(refusal([&] {
              simulator.move_pin(0, pose_at({0.0, 0.0, 1.5}));
            }),
            "pins.hand.pose = 1.5 m from the present pose: must be at most 1 m away in one step, the size of the largest body; "
            "go there in 2 steps");
  simulator.move_pin(0, pose_at({0.0, 0.0, 1.0}));
  // A rotation moves points as far as they are from the origin: this one by pi / 2 times 0.1 sqrt(3).
  simulator.move_obstacle(0, pose_at({2.5, -0.5, 0.0}, {0.0, 90.0, 0.0}));
  EXPECT_EQ(refusal([&] {
              simulator.move_obstacle(0, pose_at({3.3, -0.5, 0.0}, {0.0, 90.0, 0.0}));
            }),
            "obstacles.ball.pose = 1.07207 m from the present pose: must be at most 1 m away in one step, the size of the largest "
            "body; go there in 2 steps");
  simulator.move_obstacle(1, pose_at({0.0, -2.9, 0.0}, {10.0, 0.0, 0.0}));  // a half-space has no farthest point
}

TEST(Steering, RefusesWhatItCannotDo) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.0, -0.5, 0.0})});
  const auto pose_of = [](const std::function<void(RigidTransform&)>& change) {
    RigidTransform pose = RigidTransform::Identity();
    change(pose);
    return pose;
  };
  const std::vector<std::pair<RigidTransform, std::string>> poses{
      {pose_of([](RigidTransform& pose) { pose.translation().y() = kNotANumber; }),
       "= [0, nan, 0]: must be finite; give a position"},
      {pose_of([](RigidTransform& pose) { pose.translation().z() = -std::numeric_limits<double>::infinity(); }), "= [0, 0, -inf]"},
      {pose_of([](RigidTransform& pose) { pose.linear()(1, 2) = kNotANumber; }), "= a rotation that is not finite"},
      {pose_of([](RigidTransform& pose) { pose.linear() *= 2.0; }), "= a matrix R with |R^T R - I| = 5.2: must be a rotation"},
      {pose_of([](RigidTransform& pose) { pose.linear().setZero(); }), "= a matrix R with |R^T R - I| = 1.73: must be a rotation"},
      {pose_of([](RigidTransform& pose) { pose.linear()(0, 0) = -1.0; }), "= a reflection: must be a rotation"},
      {pose_of([](RigidTransform& pose) { pose.linear()(0, 1) = 0.5; }),
       "= a matrix R with |R^T R - I| = 0.75: must be a rotation"}};
  const SimulationState before = simulator.state();
  for (const auto& [pose, says] : poses) {
    EXPECT_THAT(refusal([&, &its = pose] { simulator.move_pin(0, its); }), HasSubstr("pins.hand.pose " + says));
    EXPECT_THAT(refusal([&, &its = pose] { simulator.move_obstacle(0, its); }), HasSubstr("obstacles.ball.pose " + says));
  }
  const auto expect = [&](const std::function<void()>& change, const std::string& says) {
    EXPECT_THAT(refusal(change), HasSubstr(says));
  };
  expect([&] { simulator.move_pin(1, RigidTransform::Identity()); },
         "pins = 1: must be the number of a pin; there is 1; count pins from 0");
  expect([&] { simulator.move_obstacle(7, RigidTransform::Identity()); },
         "obstacles = 7: must be the number of an obstacle; there is 1");
  expect([&] { (void)simulator.pin_pose(1); }, "pins = 1");
  expect([&] { (void)simulator.obstacle_pose(1); }, "obstacles = 1");
  expect([&] { simulator.pin(11); }, "particles = 11: must be the number of a particle; there are 11; count particles from 0");
  expect([&] { simulator.pin(-1); }, "particles = -1");
  expect([&] { simulator.release(11); }, "particles = 11");
  expect([&] { simulator.release(kNone); }, "particles = -1");
  expect([&] { simulator.pin({}, "x"); }, "pins.x: must contain at least one particle; name a particle");
  expect([&] { simulator.pin({3, 99}, "x"); }, "pins.x[1] = 99: must be the number of a particle; there are 11");
  expect([&] { simulator.pin({3, 4, 3}, "x"); }, "pins.x = 3: must be named once; remove the second one");
  expect([&] { simulator.pin({3}, ""); }, "must be a name, which its reaction has too; name the pin");
  expect([&] { simulator.pin({3}, "hand"); }, "pins.hand: is the name of a pin of the network already; choose another name");
  expect([&] { simulator.set_gravity({0.0, kNotANumber, 0.0}); }, "gravity");
  expect([&] { simulator.set_springs(0, SpringKind::bend, 1.0, 0.0); },
         "bodies.rope.springs.bend: has no springs; build the body with springs of this kind");
  expect([&] { simulator.set_springs(1, SpringKind::bend, 1.0, 0.0); }, "bodies = 1: must be the number of a body; there is 1");
  expect([&] { simulator.set_body_material(static_cast<std::size_t>(kNone), {}); }, "bodies = -1: must be the number of a body");
  EXPECT_EQ(simulator.state(), before);
}

TEST(Obstacles, WithoutANameAreToldByTheirNumber) {
  Obstacle nameless = ball({0.0, -0.5, 0.0});
  nameless.name.clear();
  Simulator simulator(rope({}), settings_of(), {nameless});
  EXPECT_THAT(refusal([&] { simulator.move_obstacle(0, pose_at({9.0, 0.0, 0.0})); }), HasSubstr("obstacles[0].pose = "));
  EXPECT_THAT(refusal([&] { simulator.set_obstacle_material(0, {.friction = -1.0}); }), HasSubstr("obstacles[0].friction"));
  EXPECT_THAT(refusal([&] { Simulator(rope({})).move_obstacle(0, RigidTransform::Identity()); }),
              HasSubstr("obstacles = 0: must be the number of an obstacle; there are none"));
}

// With and without air that acts: the wind alone may change at another cost than the drag.
TEST(SetAir, RefusesWindThatTheSettingsWouldRefuse) {
  using Keys = std::vector<WindKeyframe>;
  const std::vector<std::pair<Wind, std::string>> winds{
      {Wind(Vector3(kNotANumber, 0.0, 0.0)), "wind: must have three finite components"},
      {Wind(Keys{{1.0, Vector3::Zero()}, {0.5, Vector3::Ones()}}), "wind.keyframes[1].time = 0.5: must be later"},
      {Wind(Keys{{kNotANumber, Vector3::Zero()}, {1.0, Vector3::Ones()}}), "wind.keyframes[1].time = 1: must be later"},
      {Wind(Keys{{0.0, Vector3::Ones()}}, Gusts{.speed = 1.0, .length = -1.0}), "wind.gusts.length = -1: must be"},
      {Wind(Keys{{0.0, Vector3::Ones()}}, Gusts{.speed = -1.0, .length = 1.0}), "wind.gusts.speed = -1: must be"}};
  for (const double drag : {0.0, 0.1}) {
    SimulatorSettings settings = settings_of();
    settings.air_drag = drag;
    Simulator simulator(rope({hand({0})}), settings);
    const SimulationState before = simulator.state();
    for (const auto& [wind, says] : winds) {
      for (const double next_drag : {drag, drag + 0.1}) {
        EXPECT_THAT(refusal([&, &air = wind] { simulator.set_air(next_drag, air); }), HasSubstr(says));
      }
    }
    EXPECT_EQ(simulator.state(), before);
    EXPECT_EQ(simulator.settings().wind.max_speed(), 0.0);
  }
}

/// Pushes nothing, but says that it touches particles and that its elements are of particles.
class Pusher final : public Force {
 public:
  Pusher(std::optional<std::vector<Index>> first_touches, std::vector<Index> elements)
      : touches(std::move(first_touches)), elements_(std::move(elements)) {}
  [[nodiscard]] std::string name() const override { return "pusher"; }
  [[nodiscard]] std::optional<std::vector<Index>> touched() const override { return touches; }
  void add(const Kinematics& /*at*/, Points& forces) const override {
    if (fails) forces(0, 3) = kNotANumber;
  }
  void append_elements(std::vector<LinearElement>& elements) const override {
    for (const Index i : elements_) elements.push_back(LinearElement::anchor(i, 1.0e-6, 0.0));
  }
  std::optional<std::vector<Index>> touches;
  bool fails = false;

 private:
  std::vector<Index> elements_;
};

/// Keeps nothing.
class Idle final : public Constraint {
 public:
  explicit Idle(std::vector<Index> touches) : touches_(std::move(touches)) {}
  [[nodiscard]] std::optional<std::vector<Index>> touched() const override { return touches_; }
  double project(const Points& /*before*/, Points& /*positions*/, const ImpulseRecorder& /*recorder*/) const override {
    return 0.0;
  }
  [[nodiscard]] double residual(const Points& /*positions*/) const override { return 0.0; }

 private:
  std::vector<Index> touches_;
};

TEST(AddForce, RefusesWhatIsNoForceOfTheNetwork) {
  Simulator simulator(rope({hand({0})}), settings_of(), {low_ground()});
  const auto pusher = std::make_shared<Pusher>(std::vector<Index>{3}, std::vector<Index>{4});
  simulator.add_force(pusher);
  const auto idle = std::make_shared<Idle>(std::vector<Index>{3});
  simulator.add_constraint(idle);
  const SimulationState before = simulator.state();
  const auto expect = [&](const std::function<void()>& change, const std::string& says) {
    EXPECT_EQ(refusal(change), says);
    EXPECT_EQ(simulator.state(), before);
  };
  const std::string number = " = 99: must be the number of a particle; there are 11; count particles from 0";
  expect([&] { simulator.add_force(std::make_shared<Pusher>(std::vector<Index>{99}, std::vector<Index>{})); },
         "added force \"pusher\".touched()[0]" + number);
  expect(
      [&] {
        simulator.add_force(std::make_shared<Pusher>(std::nullopt, std::vector<Index>{5, 99}));
      },
      "added force \"pusher\".append_elements()[1].particles[0]" + number);
  expect(
      [&] {
        simulator.add_constraint(std::make_shared<Idle>(std::vector<Index>{0, 1, 99}));
      },
      "added constraint.touched()[2]" + number);
  expect([&] { simulator.add_force(nullptr); }, "added force = null: must be an object; make one with std::make_shared");
  expect([&] { simulator.add_constraint(nullptr); }, "added constraint = null: must be an object; make one with std::make_shared");
  const std::string twice = ": was added already; change its parameters, or make another object";
  expect([&] { simulator.add_force(pusher); }, "added force \"pusher\"" + twice);
  expect([&] { simulator.add_constraint(idle); }, "added constraint" + twice);
  pusher->touches = std::vector<Index>{99};
  run(simulator, 0.1);
  EXPECT_EQ(refusal([&] { simulator.wake(); }), "added force \"pusher\".touched()[0]" + number) << "it is asked again";
}

// Half a second of rest lets a body sleep; see RestDetector.
TEST(AddForce, WakeAsksAgainWhatItTouches) {
  NetworkBuilder builder;
  builder.begin_body("pearl", kRough);
  builder.add_particle({0.0, 0.005, 0.0}, 0.1);
  builder.begin_body("bead", kRough);
  builder.add_particle({1.0, 0.005, 0.0}, 0.1);
  Simulator simulator(builder.build(), settings_of(), {ground(kRough)});
  const auto pusher = std::make_shared<Pusher>(std::vector<Index>{0}, std::vector<Index>{});
  simulator.add_force(pusher);
  run(simulator, 2.0);
  EXPECT_FALSE(sleeps(simulator, 0));
  EXPECT_TRUE(sleeps(simulator, 1));
  pusher->touches = std::vector<Index>{1};
  simulator.wake();
  run(simulator, 2.0);
  EXPECT_TRUE(sleeps(simulator, 0));
  EXPECT_FALSE(sleeps(simulator, 1));
}

TEST(AddForce, ThatGivesNanIsNamedAsTheCause) {
  Simulator simulator(rope({hand({0})}), settings_of());
  const auto pusher = std::make_shared<Pusher>(std::nullopt, std::vector<Index>{});
  pusher->fails = true;
  simulator.add_force(pusher);
  try {
    run(simulator, 0.1);
    FAIL() << "went on";
  } catch (const StepError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a position or velocity is not finite"));
    EXPECT_THAT(error.what(), HasSubstr("check the added forces and constraints"));
  }
}

// Verlet's velocity is (x - x_previous) / dt: with half the step the same positions are twice as fast.
TEST(Restore, TakesStatesOfItsOwnStepAndIntegratorAlone) {
  SimulatorSettings fine = settings_of();
  fine.steps_per_frame = 2;
  SimulatorSettings coarse = settings_of();
  coarse.step = 2.0 * fine.step;
  SimulatorSettings implicit = fine;
  implicit.integrator = ImplicitEulerSettings{};
  Simulator had(rope({hand({0})}), fine);
  run(had, 8 * fine.step);
  const std::string remedy = "; call continue_with() with the settings of the simulator that had the state, then restore()";
  for (const auto& [settings, says] :
       {std::pair(coarse, "state.step_length = 0.0009765625: must be that of this simulator, 0.001953125" + remedy),
        {implicit, "state.integrator = VerletSettings: must be that of this simulator, ImplicitEulerSettings" + remedy}}) {
    Simulator other(rope({hand({0})}), settings);
    run(other, 4 * coarse.step);
    EXPECT_THAT(refusal([&] { other.restore(had.state()); }), HasSubstr(says));
    other.continue_with(other.model()->network(), fine);
    other.restore(had.state());
    EXPECT_EQ(other.state(), had.state());
    Simulator copy = had;
    run(copy, 8 * fine.step);
    run(other, 8 * fine.step);
    EXPECT_EQ(other.state(), copy.state());
  }
  Simulator larger(cloth(5, 0.0), fine);
  EXPECT_EQ(refusal([&] { larger.restore(had.state()); }),
            "state.x = 11 entries: must have 25 entries, one for each of the particles; give the state of a simulator of the same "
            "scene")
      << "and nothing else";
}

TEST(ContactMaterial, StaticFrictionFollowsFriction) {
  const ContactMaterial material{.friction = 0.4};
  EXPECT_EQ(material.static_friction, 0.4);
  Simulator simulator(rope({hand({0})}), settings_of(), {low_ground()});
  simulator.set_body_material(0, {.friction = 0.4});
  simulator.set_obstacle_material(0, {.friction = 0.4});
}

}  // namespace
}  // namespace sprung
