// Implicit Euler is stable at steps at which no explicit scheme is.
#include "base/error.h"
#include "base/parallel.h"
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr double kStep = 1.0 / 60.0;  // [s]

/// A level cloth of 1 m, 0.2 kg and n x n particles with springs of 1e5 N/m, pinned at two corners.
SpringNetwork stiff_cloth(Index n) {
  constexpr double kStiffness = 1.0e5;
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {n, n}}, {.structural = SpringMaterial{.value = kStiffness},
                                                                            .shear = SpringMaterial{.value = 0.5 * kStiffness},
                                                                            .bend = SpringMaterial{.value = 0.1 * kStiffness}});
  set_total_mass(shape, 0.2);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  place(shape, pose, Vector3::Zero());
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = 0.005, .friction = 0.3, .static_friction = 0.3});
  builder.pin({n * (n - 1), n * n - 1});
  return builder.build();
}

double largest_stretch(const Simulator& simulator) {
  const Springs& springs = simulator.network().springs;
  double largest = 0.0;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    const Vector3 difference = simulator.positions().col(springs.first[s]) - simulator.positions().col(springs.second[s]);
    largest = std::max(largest, difference.norm() / springs.rest_length[s] - 1.0);
  }
  return largest;
}

double moving_energy(const Simulator& simulator) {
  return 0.5 * simulator.state().v.colwise().squaredNorm().dot(simulator.network().masses.transpose()) + simulator.elastic_energy();
}

/// A ball in the path of the swinging cloth's middle.
Obstacle ball_below_cloth() {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.25}, .material = {.friction = 0.3, .static_friction = 0.3}};
  ball.rest_pose.translation() = Vector3(0.0, -0.45, -0.1);
  return ball;
}

double least_distance(const Simulator& simulator, const Obstacle& ball) {
  return (simulator.positions().colwise() - ball.rest_pose.translation()).colwise().norm().minCoeff() - 0.25;
}

TEST(ImplicitEuler, SwingsAStiffClothByTwoCornersInStepsOfASixtiethOfASecond) {
  const Obstacle ball = ball_below_cloth();
  Simulator simulator(stiff_cloth(64), {.step = kStep, .integrator = ImplicitEulerSettings{}}, {ball});
  for (int step = 0; step < 20; ++step) {
    simulator.step();
    ASSERT_GT(least_distance(simulator, ball), 0.0) << "step " << step;
    // The cloth strikes at 2 m/s: contact moves particles by two spring lengths in a step. With a single response to contact the
    // stretch is 0.15.
    ASSERT_LT(largest_stretch(simulator), simulator.contact_count() > 0 ? 0.12 : 0.1) << "step " << step;
    if (simulator.contact_count() > 0) continue;
    // The potential energy of the cloth's fall by its own size is the upper bound.
    ASSERT_LT(moving_energy(simulator), 0.2 * testing::kGravity * 1.0) << "step " << step;
  }
  EXPECT_LT(simulator.positions().row(1).mean(), -0.15) << "the cloth fell";
  EXPECT_GT(simulator.contact_count(), 0);
}

// Without a response to contact the springs stay stretched by a third and store a thousand joules; with a single one 9 % and 1.6
// J. The impact itself stretches them by 6 % for a step.
TEST(ImplicitEuler, LetsAStiffClothRestOnABall) {
  const Obstacle ball = ball_below_cloth();
  Simulator simulator(stiff_cloth(24), {.step = kStep, .integrator = ImplicitEulerSettings{}}, {ball});
  for (int step = 0; step < 120; ++step) {
    simulator.step();
    ASSERT_LT(largest_stretch(simulator), step < 60 ? 0.08 : 0.05) << "step " << step;
    ASSERT_GT(least_distance(simulator, ball), 0.0) << "step " << step;
  }
  EXPECT_GT(simulator.contact_count(), 0);
  EXPECT_LT(moving_energy(simulator), 0.1 * 0.2 * testing::kGravity * 1.0) << "a tenth of the energy of a fall by its own size";
}

// The cloth strikes at 1.3 m/s, 4 cm per step: contact moves particles by half a spring length. Springs must respond to contact
// and to truncation within the same step. Without the response to truncation they stretch by 0.35.
TEST(ImplicitEuler, GainsNoEnergyWhereItStrikesABox) {
  const ContactMaterial rough{.friction = 0.3, .static_friction = 0.3};
  const Obstacle box{.name = "box", .geometry = BoxGeometry{.size = {0.4, 0.4, 0.4}}, .material = rough};
  const ContactMaterial material{.thickness = 0.01, .friction = 0.3, .static_friction = 0.3};
  Simulator simulator(testing::cloth(13, 0.3, material), {.step = 1.0 / 30.0, .integrator = ImplicitEulerSettings{}}, {box});
  const double begin = simulator.gravity_energy();
  for (int step = 0; step < 36; ++step) {
    simulator.step();
    ASSERT_LT(moving_energy(simulator) + simulator.gravity_energy(), begin) << "step " << step;
    ASSERT_LT(largest_stretch(simulator), 0.32) << "step " << step;
  }
  EXPECT_GT(simulator.contact_count(), 0);
}

// A stiff block starts 2 mm above its gap, with and without friction. The normal impulse must persist while static friction acts
// along the ground.
TEST(ImplicitEuler, RestsABlockOnTheGround) {
  for (const double friction : {0.0, 0.4}) {
    const ContactMaterial rough{.friction = friction, .static_friction = friction};
    const auto spring = [](double modulus) {
      SpringMaterial material{.value = modulus};
      material.measure = SpringMaterial::Measure::modulus;
      material.damping_ratio = 0.2;
      return material;
    };
    BodyShape shape = make_solid({.size = Vector3::Constant(0.2), .resolution = {5, 5, 5}},
                                 {.structural = spring(5.0e5), .shear = spring(2.5e5), .bend = {}});
    set_density(shape, 1000.0);
    RigidTransform pose = RigidTransform::Identity();
    pose.translation().y() = 0.112;
    place(shape, pose, Vector3::Zero());
    NetworkBuilder builder;
    builder.add_body("block", shape, {.thickness = 0.01, .friction = friction, .static_friction = friction});
    Simulator simulator(builder.build(), {.step = 1.0 / 30.0, .integrator = ImplicitEulerSettings{}}, {testing::ground(rough)});
    const double begin = simulator.gravity_energy();
    for (int step = 0; step < 60; ++step) {
      simulator.step();
      // Rounding of the 8 J of gravity energy at rest.
      ASSERT_LT(moving_energy(simulator) + simulator.gravity_energy(), begin * (1.0 + 1.0e-12))
          << "friction " << friction << ", step " << step;
    }
    // The weight shortens the block by m g L / (E A) / 2, at most a fifth of a per cent of 0.2 m.
    const double height = simulator.positions().row(1).maxCoeff() - simulator.positions().row(1).minCoeff();
    EXPECT_NEAR(height, 0.2, 0.002 * 0.2) << "friction " << friction;
    EXPECT_LT(simulator.state().v.colwise().norm().maxCoeff(), 1.0e-3);
  }
}

// The weight is beyond the supports, so that the far foot rises. In each step it falls freely at first, and contact pushes it
// before the springs lift it. About the near foot, which friction holds, the torque is 10 kg g 1 m - 1 kg g 1 m and the inertia 10
// kg (1 + 1) m^2 + 1 kg m^2. A constant acceleration a moves it by a dt^2 n (n + 1) / 2 in n steps. At the end the angle of 0.02
// makes the torque 2 % larger.
TEST(ImplicitEuler, TipsABodyWhoseWeightIsBeyondItsSupports) {
  constexpr double kTimeStep = 0.01;
  constexpr int kSteps = 10;
  constexpr double kGap = 0.01;
  constexpr double kStiffness = 1.0e7;
  NetworkBuilder builder;
  builder.begin_body("crane", {.thickness = kGap, .friction = 1.0, .static_friction = 1.0});
  const Index far = builder.add_particle({0.0, kGap, 0.0}, 1.0);
  const Index near = builder.add_particle({1.0, kGap, 0.0}, 1.0);
  const Index weight = builder.add_particle({2.0, kGap + 1.0, 0.0}, 10.0);
  builder.add_spring(far, near, kStiffness, 1.0);
  builder.add_spring(near, weight, kStiffness, std::sqrt(2.0));
  builder.add_spring(far, weight, kStiffness, std::sqrt(5.0));
  Simulator simulator(builder.build(), {.step = kTimeStep, .integrator = ImplicitEulerSettings{}},
                      {testing::ground({.friction = 1.0, .static_friction = 1.0})});
  for (int step = 0; step < kSteps; ++step) simulator.step();
  const double angular_acceleration = 9.0 * testing::kGravity / (10.0 * 2.0 + 1.0);
  const double risen = angular_acceleration * kTimeStep * kTimeStep * kSteps * (kSteps + 1) / 2.0;
  EXPECT_NEAR(simulator.positions()(1, far) - kGap, risen, 0.02 * risen);
  EXPECT_NEAR(simulator.positions()(1, near), kGap, 1.0e-3 * risen);
}

TEST(ImplicitEuler, TakesStepsThatExplicitSchemesDoNotSurvive) {
  EXPECT_THROW(Simulator(stiff_cloth(16), {.step = kStep, .integrator = SymplecticEulerSettings{}}), InputError);
  Simulator unstable(stiff_cloth(16), {.step = kStep, .integrator = SymplecticEulerSettings{}, .stability = StabilityCheck::warn});
  EXPECT_THROW(testing::run(unstable, 1.0), StepError);
}

// The penalty is one of the implicit forces. A ball of 0.1 kg comes to rest m g / k below its gap, with a step of 10 / omega.
TEST(ImplicitEuler, RestsOnAPenaltyAtAnyStep) {
  const double stiffness = 0.1 * std::pow(10.0 / kStep, 2);
  SimulatorSettings settings{.step = kStep, .integrator = ImplicitEulerSettings{}};
  settings.contact = {.response = ContactSettings::Response::penalty, .stiffness = stiffness, .damping = 0.0};
  Simulator simulator(testing::one_particle({0.0, 0.011, 0.0}, {.thickness = 0.01}), settings, {testing::ground()});
  testing::run(simulator, 5.0);
  EXPECT_NEAR(simulator.positions()(1, 0), 0.01 - 0.1 * testing::kGravity / stiffness, 1.0e-12);
}

// An angle stiffness of 1e3 N m on masses of 1 g has modes from 10 to 1e7 1/s.
TEST(ImplicitEuler, SwingsARopeThatIsStiffAgainstBending) {
  NetworkBuilder builder;
  constexpr Index kParticles = 20;
  for (Index i = 0; i < kParticles; ++i) builder.add_particle(Vector3(0.05 * i, 0.0, 0.0), 1.0e-3);
  for (Index i = 0; i + 1 < kParticles; ++i) builder.add_spring(i, i + 1, 1.0e5, 0.05);
  for (Index i = 0; i + 2 < kParticles; ++i) builder.add_angle_bend(i, i + 1, i + 2, 1.0e3);
  builder.pin(0);
  Simulator simulator(builder.build(), {.step = kStep, .integrator = ImplicitEulerSettings{}});
  for (int step = 0; step < 60; ++step) {
    simulator.step();
    // The upper bound is the energy of a fall by twice the length, and the energy that the springs store while a linear step turns
    // them.
    ASSERT_LT(moving_energy(simulator), 2.0 * 0.02 * testing::kGravity * 0.95) << "step " << step;
  }
  const Vector3 tip = simulator.positions().col(kParticles - 1);
  EXPECT_NEAR(tip.norm(), 0.95, 0.01) << "a rod";
}

TEST(ImplicitEuler, DoesNotDependOnTheNumberOfThreads) {
  const auto ten_steps = [](int threads) {
    const ThreadLimit limit(threads);
    Simulator simulator(stiff_cloth(16), {.step = kStep, .integrator = ImplicitEulerSettings{}});
    for (int step = 0; step < 10; ++step) simulator.step();
    return simulator.positions();
  };
  EXPECT_EQ(ten_steps(1), ten_steps(2));
}

}  // namespace
}  // namespace sprung
