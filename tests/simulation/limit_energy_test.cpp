// A stretch limit adds no energy, at any step and with any scheme.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

using testing::kGravity;

constexpr double kMass = 0.2;
constexpr double kSeconds = 0.8;  // down and most of the swing up again

constexpr SpringMaterial kLimp{.value = 0.0};

/// A cloth of 1 m and n x n particles, pinned at two corners, rotated by `turned` [degrees] about x (0: vertical).
SpringNetwork pinned_cloth(Index n, const SpringMaterial& structural = kLimp, const SpringMaterial& shear = kLimp,
                           double turned = -90.0) {
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {n, n}}, {.structural = structural, .shear = shear});
  set_total_mass(shape, kMass);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({turned, 0.0, 0.0});
  place(shape, pose, Vector3::Zero());
  NetworkBuilder builder;
  const Index first = builder.add_body("cloth", shape);
  builder.pin(first + n * (n - 1));
  builder.pin(first + n * n - 1);
  return builder.build();
}

/// The number of times that the middle of a hanging cloth passes below its pins.
int passes_under_pins(const SpringNetwork& network, const StretchLimitSettings& limit, int rate, double seconds) {
  const double pins_at = network.positions(2, network.pins.front().particles.front());
  Simulator simulator(network, {.step = 1.0 / rate, .integrator = VerletSettings{.damping_rate = 0.3}, .stretch_limit = limit});
  int passes = 0;
  double before = network.positions.row(2).mean() - pins_at;
  for (int step = 0; step < seconds * rate; ++step) {
    simulator.step();
    const double beside = simulator.positions().row(2).mean() - pins_at;
    if (beside * before < 0.0) ++passes;
    before = beside;
  }
  return passes;
}

// At a turning point a step gains little energy, but the cloth must not stop there. Half a degree from the vertical, gravity pulls
// it back with a hundredth of its weight. A sheet of 1 m swings through in pi sqrt(2 / (3 g)) = 0.82 s: 7 times within the
// duration.
TEST(LimitMotion, AClothHalfADegreeFromVerticalSwingsUnderNewton) {
  for (const double max_stretch : {0.0, 0.02}) {
    const StretchLimitSettings limit{.max_stretch = max_stretch, .tolerance = 0.01, .solver = StretchLimitSettings::Solver::newton};
    for (const int rate : {30, 60, 120, 960}) {
      EXPECT_GE(passes_under_pins(pinned_cloth(16, kLimp, kLimp, -0.5), limit, rate, 6.0), 5) << max_stretch << ", " << rate;
    }
  }
}

// A pendulum of 1 m that is released at rest 0.1 mm beside its pin reaches the same amplitude on the other side after half a
// period, pi sqrt(L / g) = 1.003 s, which is 241 steps. Over such small angles its motion is linear, so the amplitude is no matter
// to the ratio; a swing of half a degree loses less than a tenth here too.
TEST(LimitMotion, ARopeAThousandthOfADegreeFromVerticalSwingsUnderNewton) {
  for (const double amplitude : {1e-2, 1e-4, 2e-5}) {
    NetworkBuilder builder;
    builder.begin_body("pendulum");
    builder.add_particle(Vector3::Zero(), kMass);
    builder.add_particle({amplitude, -1.0, 0.0}, kMass);
    builder.add_spring(0, 1, 0.0, 1.0, 0.0);
    builder.pin(0);
    Simulator simulator(builder.build(), {.step = 1.0 / 240.0, .stretch_limit = StretchLimitSettings{.max_stretch = 0.0}});
    for (int step = 0; step < 241; ++step) simulator.step();
    EXPECT_LT(simulator.positions()(0, 1), -0.9 * amplitude) << amplitude;
  }
}

// Springs between pins that are pulled apart store far more energy than gravity changes in a small step, and keep it. Their energy
// is no measure of rest.
TEST(LimitMotion, ATautClothSwingsUnderNewton) {
  SpringNetwork network = pinned_cloth(16, kLimp, kLimp, -20.0);
  network.positions(0, network.pins.front().particles.front()) -= 0.015;
  network.positions(0, network.pins.back().particles.back()) += 0.015;
  const StretchLimitSettings limit{.max_stretch = 0.0, .tolerance = 0.05, .solver = StretchLimitSettings::Solver::newton};
  EXPECT_GE(passes_under_pins(network, limit, 960, 6.0), 6);
}

/// The largest increase [J] of the kinetic, gravity and elastic energy over its initial value.
double most_gained(const SpringNetwork& network, double step, const StretchLimitSettings& limit,
                   const IntegratorSettings& integrator = SimulatorSettings{}.integrator, double seconds = kSeconds) {
  Simulator simulator(network, {.step = step, .integrator = integrator, .stretch_limit = limit});
  const auto energy = [&] {
    return 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose()) + simulator.gravity_energy() +
           simulator.elastic_energy();
  };
  const double begin = energy();
  double most = 0.0;
  for (double time = 0.0; time < seconds; time += step) {
    simulator.step();
    most = std::max(most, energy() - begin);
  }
  return most;
}

// A body that falls by a height h lags behind its velocity by at most half a step's displacement, g t dt / 2. This is an energy of
// m g sqrt(2 g h) dt / 2, 1.5 mJ at the largest step here. Springs that support it yield by a tenth of the tolerance.
TEST(LimitEnergy, NewtonGainsNoEnergyInSmallSteps) {
  for (const double tolerance : {0.001, 0.005, 0.02}) {
    const StretchLimitSettings limit{.max_stretch = 0.01, .tolerance = tolerance, .solver = StretchLimitSettings::Solver::newton};
    for (const Index side : {2, 5}) {
      for (const int steps_a_frame : {50, 200, 1000}) {
        const double step = 1.0 / (60.0 * steps_a_frame);
        const double lag = kMass * kGravity * std::sqrt(2.0 * kGravity) * step / 2.0;
        const double yields = kMass * kGravity * 0.1 * tolerance;
        EXPECT_LT(most_gained(pinned_cloth(side), step, limit), lag + yields) << tolerance << ", " << side << ", " << steps_a_frame;
      }
    }
  }
}

/// An upright cloth of 1 m and 9 x 9 particles with soft springs that hangs by its upper corners.
SpringNetwork soft_hanging_cloth() {
  BodyShape shape = make_cloth(
      {.size = {1.0, 1.0}, .resolution = {9, 9}},
      {.structural = SpringMaterial{.value = 100.0}, .shear = SpringMaterial{.value = 10.0}, .bend = SpringMaterial{.value = 1.0}});
  set_total_mass(shape, 0.3);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  builder.pin({72, 80});
  return builder.build();
}

// The cloth sinks by the 2 % of its limit and then swings until it rests. A body that falls by a height h lags behind its velocity
// by at most half a step's displacement, g t dt / 2. By that much its energy may seem to rise.
TEST(LimitEnergy, SoftSpringsUnderNewtonComeToRest) {
  const StretchLimitSettings limit{.max_stretch = 0.02, .solver = StretchLimitSettings::Solver::newton};
  const SpringNetwork network = soft_hanging_cloth();
  constexpr double kStep = 1.0 / 540.0;
  Simulator simulator(network, {.step = kStep, .integrator = VerletSettings{.damping_rate = 3.0}, .stretch_limit = limit});
  const double lag = 0.3 * kGravity * std::sqrt(2.0 * kGravity * 0.02) * kStep / 2.0;
  double least = 0.0;
  for (int step = 0; step < 6 * 540; ++step) {
    simulator.step();
    const double energy = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose()) +
                          simulator.gravity_energy() + simulator.elastic_energy();
    least = std::min(least, energy);
    ASSERT_LT(energy - least, lag) << "step " << step;
  }
  EXPECT_LT(least, 0.0);
}

// Nearly all springs are at their limit most of the time.
TEST(LimitEnergy, StiffSwingingSpringsGainNoEnergyUnderNewton) {
  const StretchLimitSettings limit{.max_stretch = 0.02, .solver = StretchLimitSettings::Solver::newton};
  const SpringNetwork network = pinned_cloth(13, {.value = 500.0}, {.value = 20.0});
  constexpr double kStep = 1.0 / 1050.0;
  const double lag = kMass * kGravity * std::sqrt(2.0 * kGravity) * kStep / 2.0;
  EXPECT_LT(most_gained(network, kStep, limit), lag);
}

/// A level rope of 1 m, pinned at one end. The stretch limit allows less stretch than its springs would.
SpringNetwork pinned_rope(Index n, double stiffness) {
  RopeShape rope;
  rope.points = {Vector3::Zero(), Vector3::UnitX()};
  rope.particles = n;
  BodyShape shape = make_rope(rope, {.structural = SpringMaterial{.value = stiffness}});
  set_total_mass(shape, kMass);
  NetworkBuilder builder;
  builder.pin(builder.add_body("rope", shape));
  return builder.build();
}

class SchemeUnderALimit : public ::testing::TestWithParam<IntegratorSettings> {};

// The limit removes a spring's stretch and its energy. The spring must not pull as well.
TEST_P(SchemeUnderALimit, GainsNoEnergy) {
  const StretchLimitSettings limit{.max_stretch = 0.01, .solver = StretchLimitSettings::Solver::newton};
  for (const Index particles : {6, 21}) {
    for (const double stiffness : {500.0, 5000.0}) {
      const double per_particle = kMass / static_cast<double>(particles);
      const double step = 0.9 * std::sqrt(per_particle / stiffness);  // nearly the largest stable step
      const double lag = kMass * kGravity * std::sqrt(2.0 * kGravity) * step / 2.0;
      EXPECT_LT(most_gained(pinned_rope(particles, stiffness), step, limit, GetParam()), lag)
          << particles << " particles, " << stiffness << " N/m";
    }
  }
}

/// A cube of 0.3 m, pinned along one of its upper edges.
SpringNetwork pinned_cube() {
  BodyShape shape = make_solid({.size = Vector3::Constant(0.3), .resolution = {2, 2, 2}},
                               {.structural = SpringMaterial{.value = 500.0}, .shear = SpringMaterial{.value = 250.0}});
  set_total_mass(shape, kMass);
  NetworkBuilder builder;
  const Index first = builder.add_body("cube", shape);
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    if (shape.positions[i].x() < 0.0 && shape.positions[i].y() > 0.0) builder.pin(first + static_cast<Index>(i));
  }
  return builder.build();
}

// Springs push the cube while it turns. A push along the rotated direction would do work in every step.
TEST_P(SchemeUnderALimit, GainsNoEnergyFromSpringsThatMayNotShrink) {
  const StretchLimitSettings limit{.max_compression = 0.0, .kinds = {SpringKind::structural, SpringKind::shear}};
  constexpr double kStep = 1.0 / 400.0;
  const double lag = kMass * kGravity * std::sqrt(2.0 * kGravity * 0.3) * kStep / 2.0;
  EXPECT_LT(most_gained(pinned_cube(), kStep, limit, GetParam(), 10.0), lag);
}

INSTANTIATE_TEST_SUITE_P(Schemes, SchemeUnderALimit,
                         ::testing::Values(SymplecticEulerSettings{}, VerletSettings{}, VelocityVerletSettings{},
                                           RungeKutta4Settings{}, ImplicitEulerSettings{}));

}  // namespace
}  // namespace sprung
