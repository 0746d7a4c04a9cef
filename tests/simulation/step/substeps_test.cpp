// What substeps do. Time and motion do not depend on their number and length.
#include "base/error.h"
#include "base/parallel.h"
#include "collision/sample_meshes.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace sprung {
namespace {

using testing::cloth;
using testing::ground;
using testing::one_particle;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRate = 60.0;

/// No spring may stretch or shrink by more than 1 %.
StretchLimitSettings both_ways() {
  return {.max_stretch = 0.0,
          .max_compression = 0.0,
          .kinds = {SpringKind::structural, SpringKind::shear},
          .iterations = 1,
          .tolerance = 0.01,
          .tethers = true};
}

// Verlet's positions lie on the parabola of free flight at any step.
TEST(Substeps, KeepsVerletOnTheParabola) {
  const SpringNetwork ball = testing::one_particle(Vector3::Zero(), {}, Vector3(1.0, 2.0, 0.0));
  const Vector3 g(0.0, -testing::kGravity, 0.0);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(ball, g));
  const auto integrator = make_integrator(VerletSettings{}, ball);
  SimulationState state = initial_state(ball);
  constexpr double kStep = 0.01;
  integrator->start(state, forces, kStep);
  for (; state.step < 5; ++state.step) integrator->advance(state, forces, kStep);
  state.substeps = 4;
  integrator->step_changed(state, forces, kStep, 0.25 * kStep);
  for (int substep = 0; substep < 12; ++substep) integrator->advance(state, forces, 0.25 * kStep);
  state.substeps = 1;
  integrator->step_changed(state, forces, 0.25 * kStep, kStep);
  for (int step = 0; step < 4; ++step) integrator->advance(state, forces, kStep);
  const double t = 12 * kStep;
  // 21 steps with a few roundings each of differences that later steps add up. Positions are below 1 m.
  EXPECT_LT((state.x.col(0) - (t * Vector3(1.0, 2.0, 0.0) + 0.5 * t * t * g)).norm(), 21 * 21 * kEpsilon);
}

/// A level cloth of 1 m that swings from two of its corners.
SpringNetwork swinging_cloth(Index side) {
  SpringNetwork network = testing::cloth(side, 0.0);
  network.springs.stiffness.assign(network.springs.stiffness.size(), 0.0);
  network.springs.damping.assign(network.springs.damping.size(), 0.0);
  network.pins.push_back({.particles = {side * (side - 1), side * side - 1}, .origin = Vector3::Zero(), .motion = {}});
  for (const Index i : network.pins[0].particles) network.inverse_masses[i] = 0.0;
  return network;
}

struct Swing {
  Points x;
  double energy = 0.0;        ///< kinetic and gravity energy [J]
  double worst_excess = 0.0;  ///< after any step
  int max_substeps = 0;
};

/// Runs 1.5 s with `steps_a_frame` steps per frame.
Swing swing(const SpringNetwork& network, int steps_a_frame, int max_substeps, const StretchLimitSettings& limit = both_ways()) {
  Simulator simulator(network, {.step = 1.0 / (kRate * steps_a_frame), .stretch_limit = limit, .max_substeps = max_substeps});
  Swing swing;
  for (int step = 1; step <= 90 * steps_a_frame; ++step) {
    const StepReport report = simulator.step();
    EXPECT_EQ(simulator.time(), step * simulator.settings().step);
    swing.worst_excess = std::max(swing.worst_excess, report.stretch_excess);
    swing.max_substeps = std::max(swing.max_substeps, report.substeps);
  }
  swing.x = simulator.positions();
  swing.energy = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose()) + simulator.gravity_energy();
  return swing;
}

TEST(Substeps, KeepsTheLimitAndTheEnergyOfASwingingCloth) {
  const SpringNetwork cloth = swinging_cloth(16);
  const Swing coarse = swing(cloth, 8, 1);
  const Swing refined = swing(cloth, 8, 8);
  const Swing fine = swing(cloth, 80, 1);
  EXPECT_EQ(coarse.max_substeps, 1);
  EXPECT_EQ(refined.max_substeps, 8);
  EXPECT_GT(coarse.worst_excess, 0.05);
  EXPECT_LT(refined.worst_excess, 0.04);
  const double height = 0.2 * testing::kGravity * 1.0;  // the lower edge may fall by 1 m
  EXPECT_NEAR(refined.energy, fine.energy, 0.1 * height);
}

// A global solve keeps the limit at any step, but loses kinetic energy of the fall.
TEST(Substeps, KeepsTheEnergyOfATurningCloth) {
  const StretchLimitSettings limit{.max_stretch = 0.0, .tolerance = 0.01, .solver = StretchLimitSettings::Solver::newton};
  const SpringNetwork cloth = swinging_cloth(16);
  const Swing coarse = swing(cloth, 1, 1, limit);
  const Swing refined = swing(cloth, 1, 8, limit);
  const Swing fine = swing(cloth, 10, 1, limit);
  EXPECT_GT(refined.max_substeps, 2);
  for (const Swing& run : {coarse, refined, fine}) EXPECT_LT(run.worst_excess, 0.02);
  const double fall = 0.2 * testing::kGravity * 0.5;  // a fall by half its length
  EXPECT_LT(coarse.energy, fine.energy - 0.2 * fall);
  EXPECT_NEAR(refined.energy, fine.energy, 0.1 * fall);
}

TEST(Substeps, BeginsWithTheSmallestSubstepsIfBodiesMove) {
  NetworkBuilder builder;
  const Vector3 velocity(0.0, 0.0, 10.0);
  const Index first = builder.add_particle({0.0, 0.0, 0.0}, 1.0, velocity);
  builder.add_spring(first, builder.add_particle({1.0, 0.0, 0.0}, 1.0, velocity), 0.0, 1.0, 0.0);
  SimulatorSettings settings{.step = 1.0 / kRate,
                             .stretch_limit = StretchLimitSettings{.solver = StretchLimitSettings::Solver::gauss_seidel},
                             .max_substeps = 8};
  EXPECT_EQ(Simulator(builder.build(), settings).step().substeps, 1) << "passes refine only after missed steps";
  settings.stretch_limit->solver = StretchLimitSettings::Solver::automatic;
  Simulator simulator(builder.build(), settings);
  EXPECT_EQ(simulator.step().substeps, 8);
  EXPECT_EQ(simulator.step().substeps, 1) << "the springs fly without turning";
  SpringNetwork resting = builder.build();
  resting.velocities.setZero();
  EXPECT_EQ(Simulator(resting, settings).step().substeps, 1);
  resting.pins.push_back({.particles = {first}, .origin = Vector3::Zero(), .motion = {.spin = {0.0, 90.0, 0.0}}});
  resting.inverse_masses[first] = 0.0;
  EXPECT_EQ(Simulator(resting, settings).step().substeps, 8);
}

// A spring flies, slack and without forces. Its displacement in a substep is multiplied n times by the n-th root of 1 - damping.
TEST(Substeps, TheDampingOfVerletIsThatOfAStep) {
  constexpr double kDamping = 0.3;
  NetworkBuilder builder;
  const Vector3 velocity(0.0, 0.0, 10.0);
  const Index first = builder.add_particle({0.0, 0.0, 0.0}, 1.0, velocity);
  builder.add_spring(first, builder.add_particle({1.0, 0.0, 0.0}, 1.0, velocity), 0.0, 1.0, 0.0);
  Simulator simulator(builder.build(), {.step = 1.0 / kRate,
                                        .gravity = Vector3::Zero(),
                                        .integrator = VerletSettings{.damping = kDamping},
                                        .stretch_limit = StretchLimitSettings{},
                                        .max_substeps = 8});
  ASSERT_EQ(simulator.step().substeps, 8);
  // Positions below 1 m are rounded before eight differences are divided by the substep.
  EXPECT_NEAR(simulator.state().v(2, 0), (1.0 - kDamping) * velocity.z(), 8 * kEpsilon * 8 * kRate);
}

// Eight substeps equal eight steps. This includes Verlet's first step and penalty friction, which stops a sliding particle within
// a step if it can.
TEST(Substeps, TheFirstSubstepsAreStepsOfTheirLength) {
  const ContactMaterial rough{.thickness = 0.01, .friction = 100.0, .static_friction = 100.0};
  NetworkBuilder builder;
  builder.begin_body("stick", rough);
  const Vector3 velocity(1.0, 0.0, 0.0);
  const Index first = builder.add_particle({0.0, 0.005, 0.0}, 1.0, velocity);
  builder.add_spring(first, builder.add_particle({1.0, 0.005, 0.0}, 1.0, velocity), 0.0, 1.0);
  const auto after_a_frame = [&](int max_substeps, int steps) {
    SimulatorSettings settings{.step = 1.0 / (kRate * steps),
                               .stretch_limit = StretchLimitSettings{.solver = StretchLimitSettings::Solver::newton},
                               .max_substeps = max_substeps};
    settings.contact = {.response = ContactSettings::Response::penalty, .stiffness = 1000.0};
    Simulator simulator(builder.build(), settings, {testing::ground(rough)});
    for (int step = 0; step < steps; ++step) EXPECT_EQ(simulator.step().substeps, 8 / steps);
    EXPECT_GT(simulator.contact_count(), 0);
    return simulator.positions();
  };
  EXPECT_EQ(after_a_frame(8, 1), after_a_frame(1, 8));
}

// The cloth starts unstretched, so it bounces at first. Smaller steps would only make it bounce higher.
TEST(Substeps, DoesNotRefineAHangingCloth) {
  SpringNetwork cloth = swinging_cloth(64);
  cloth.positions.row(1) = -cloth.positions.row(2);
  cloth.positions.row(2).setZero();
  ASSERT_GT(cloth.positions(1, cloth.pins[0].particles[0]), cloth.positions(1, 0));
  EXPECT_EQ(swing(cloth, 27, 8).max_substeps, 1);
}

// Dampers depend on the pin's velocity. The longer the step, the longer the chord of the circular path, and the more inward it
// points.
TEST(Substeps, PinsHaveTheVelocityOfTheNextSubstep) {
  SpringNetwork cloth = swinging_cloth(16);
  Pin& pin = cloth.pins.front();
  pin.motion.spin = Vector3(0.0, 0.0, 90.0);
  const Index pinned = pin.particles.back();
  const auto pinned_at = [&](double time) -> Vector3 {
    return pin.motion.pose(RigidTransform::Identity(), time) * cloth.positions.col(pinned);
  };
  Simulator simulator(cloth, {.step = 1.0 / (8 * kRate), .stretch_limit = both_ways(), .max_substeps = 8});
  int changes = 0;
  for (int step = 0, substeps = 1; step < 500; ++step) {
    simulator.step();
    const SimulationState& state = simulator.state();
    changes += state.substeps != substeps ? 1 : 0;
    substeps = state.substeps;
    const double dt = simulator.settings().step / substeps;
    const Vector3 expected = (pinned_at(simulator.time() + dt) - pinned_at(simulator.time())) / dt;
    // Positions below 2 m are rounded before their difference is divided by the step.
    ASSERT_LT((state.v.col(pinned) - expected).norm(), 16 * kEpsilon / dt) << "step " << step;
  }
  EXPECT_GT(changes, 1);
}

TEST(Substeps, DoesNotDependOnTheNumberOfThreads) {
  const SpringNetwork cloth = swinging_cloth(40);
  const auto positions = [&](int threads) {
    const ThreadLimit limit(threads);
    return swing(cloth, 4, 4).x;
  };
  EXPECT_EQ(positions(1), positions(2));
}

TEST(Substeps, AnInvalidNumberOfSubstepsIsRefused) {
  for (const int substeps : {0, kMaxSubsteps + 1}) {
    try {
      const Simulator simulator(testing::one_particle(Vector3::Zero()), {.max_substeps = substeps});
      FAIL() << substeps;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().front().key, "max_substeps");
    }
  }
}

// Within a contact step, a plate is where it is in each inner substep: it hits a particle at rest when it arrives.
TEST(InnerSubsteps, APlateHitsWhenItArrives) {
  const int inner = 8;
  const double step = 1.0 / 240.0;
  const double speed = 2.0;  // [m/s]
  SimulatorSettings settings{.step = step, .gravity = Vector3::Zero(), .inner_substeps = inner};
  Obstacle plate = ground();
  plate.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, speed, 0.0}}};
  const double thickness = 0.01;
  const double hit = 6.5 / inner * step;  // [s]
  Simulator simulator(one_particle({0.0, thickness + speed * hit, 0.0}, {.thickness = thickness, .restitution = 1.0}), settings,
                      {plate});
  simulator.step();
  // It leaves with twice the speed of the plate, at the end of the inner substep in which they meet.
  EXPECT_NEAR(simulator.state().v(1, 0), 2.0 * speed, 1e-9);
  const double expected = thickness + speed * hit + 2.0 * speed * (step - hit);
  EXPECT_NEAR(simulator.positions()(1, 0), expected, 2.0 * speed * step / inner);
}

// Truncation takes motion away. What it moved over a whole contact step is no motion of the last inner substep.
TEST(InnerSubsteps, TruncationThrowsNothingBack) {
  SimulatorSettings settings{.step = 1.0 / 240.0, .stretch_limit = StretchLimitSettings{.max_stretch = 0.02}, .inner_substeps = 8};
  SpringNetwork network = cloth(17, 0.4, {.thickness = 0.001});
  std::ranges::fill(network.springs.stiffness, 0.0);
  std::ranges::fill(network.springs.damping, 0.0);
  network.velocities.row(1).setConstant(-8.0);
  TriangleMesh star = test::needles(12);
  star.vertices *= 0.35;
  Simulator simulator(network, settings,
                      {{.name = "star", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(std::move(star))}}});
  const auto energy = [&] {
    double kinetic = 0.0;
    for (Index i = 0; i < simulator.network().particle_count(); ++i) {
      kinetic += 0.5 * simulator.network().masses[i] * simulator.state().v.col(i).squaredNorm();
    }
    return kinetic + simulator.gravity_energy();
  };
  const double start = energy();
  Index truncated = 0;
  double highest = 0.0;
  for (int step = 0; step < 48; ++step) {
    truncated += simulator.step().truncated;
    highest = std::max(highest, energy());
  }
  EXPECT_GT(truncated, 0);
  // Verlet's velocity is that of half a substep ago, so the energy of the start is off by m g v h / 2, g h / v = 0.06 % of it.
  EXPECT_LE(highest, 1.001 * start);
}

TEST(InnerSubsteps, StayWhenTheLimitGoes) {
  NetworkBuilder builder;
  builder.add_particle(Vector3(0.0, 1.0, 0.0), 1.0);
  Simulator simulator(builder.build(), {.step = 0.01, .stretch_limit = StretchLimitSettings{}, .inner_substeps = 4});
  EXPECT_EQ(simulator.step().substeps, 4);
  simulator.set_stretch_limit(std::nullopt);
  EXPECT_EQ(simulator.step().substeps, 4);
}

TEST(InnerSubsteps, NeedProjectionAndAnExplicitScheme) {
  const auto refusal = [](const SimulatorSettings& settings) {
    NetworkBuilder builder;
    builder.add_particle(Vector3::Zero(), 1.0);
    try {
      const Simulator simulator(builder.build(), settings);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const SimulatorSettings four{.inner_substeps = 4};
  EXPECT_EQ(refusal(four), "");
  for (int k = 0; k < 2; ++k) {
    SimulatorSettings other = four;
    if (k == 0) other.integrator = ImplicitEulerSettings{};
    if (k == 1) other.contact = {.response = ContactSettings::Response::penalty, .stiffness = 1.0};
    EXPECT_THAT(refusal(other),
                ::testing::HasSubstr("inner_substeps = 4: must be 1 with penalty contact and with implicit Euler; leave it out"))
        << k;
  }
}

}  // namespace
}  // namespace sprung
