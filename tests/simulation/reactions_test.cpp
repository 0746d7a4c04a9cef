// Laws of the forces of pins and the tension of springs.
#include "simulation/scenes.h"
#include "simulation/tension.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using testing::ground;
using ::testing::IsEmpty;
using testing::kGravity;
using testing::mass;
using testing::momentum;
using testing::run;

using Solver = StretchLimitSettings::Solver;

constexpr double kStep = 1.0e-3;  // [s]

/// A way to hold a body together; the limits act on springs without stiffness.
struct Holding {
  const char* name;
  std::optional<StretchLimitSettings> limit;

  [[nodiscard]] SpringMaterial material() const { return {.value = limit ? 0.0 : 100.0, .damping = limit ? 0.0 : 0.2}; }
};

std::vector<Holding> holdings() {
  return {{"springs", {}},
          {"passes", StretchLimitSettings{.max_stretch = 0.02, .solver = Solver::gauss_seidel}},
          {"passes and tethers", StretchLimitSettings{.max_stretch = 0.02, .tethers = true, .solver = Solver::gauss_seidel}},
          {"newton", StretchLimitSettings{.max_stretch = 0.02, .solver = Solver::newton}},
          {"automatic", StretchLimitSettings{.max_stretch = 0.02}}};
}

SimulatorSettings settings_of(const Holding& holding, const IntegratorSettings& integrator = VerletSettings{}) {
  return {.step = kStep, .integrator = integrator, .stretch_limit = holding.limit, .record_forces = true};
}

/// A rope of n particles and 0.1 kg, from the origin along `to` [m], whose given particles are pinned, each by a pin of its own.
SpringNetwork rope(Index n, const Vector3& to, const Holding& holding, const std::vector<Index>& pinned) {
  BodyShape shape = make_rope({.points = {Vector3::Zero(), to}, .particles = n, .length = {}}, {.structural = holding.material()});
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  for (const Index particle : pinned) builder.pin(particle);
  return builder.build();
}

/// A horizontal cloth of 0.2 kg with 9 x 9 particles, two corners of which are pinned.
SpringNetwork cloth(const Holding& holding) {
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {9, 9}},
                               {.structural = holding.material(), .shear = SpringMaterial{.value = 20.0, .damping = 0.1}});
  set_total_mass(shape, 0.2);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  builder.pin(0);
  builder.pin(8);
  return builder.build();
}

/// A cube of 0.5 kg that keeps its volume and hangs by three of its corners.
SpringNetwork jelly(const Holding& /*holding*/) {
  const SpringMaterial material{.value = 60.0, .damping = 0.12};
  BodyShape shape = make_solid({.size = {0.3, 0.3, 0.3}, .resolution = {4, 4, 4}}, {.structural = material, .shear = material});
  set_total_mass(shape, 0.5);
  shape.preserve_volume = true;
  NetworkBuilder builder;
  builder.add_body("jelly", shape);
  builder.pin({12, 13});
  builder.pin(15);
  builder.pin(63);
  return builder.build();
}

Vector3 sum_of(const std::vector<Reaction>& reactions) {
  Vector3 sum = Vector3::Zero();
  for (const Reaction& reaction : reactions) sum += reaction.force;
  return sum;
}

/// What pins give to bodies in `seconds` beyond the gain of momentum and the weight, relative to the weight.
double imbalance(Simulator& simulator, double seconds) {
  simulator.reset_forces();
  const Vector3 before = momentum(simulator);
  run(simulator, seconds);
  const Vector3 gained = (momentum(simulator) - before) / seconds;
  const Vector3 weight = mass(simulator) * simulator.settings().gravity;
  return (sum_of(simulator.reactions()) - (gained - weight)).norm() / weight.norm();
}

class ReactionsOfScheme : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static IntegratorSettings integrator() { return all_integrators()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(Integrators, ReactionsOfScheme, ::testing::Range(std::size_t{0}, all_integrators().size()));

// A position of about 1 m is rounded by epsilon / 2 in each of some 100 projections of a step, which changes the force that a
// particle's share of the mass shows by m epsilon / dt^2 = 2e-10 m [N] a projection; over 100 steps, independent of each other, and
// many particles the mean has far less than a hundred times that, 2e-9 of the weight. The linear systems are solved as precisely.
constexpr double kRounding = 1.0e-8;

TEST_P(ReactionsOfScheme, AllPinsTogetherGiveTheGainOfMomentumMinusTheWeight) {
  for (const Holding& holding : holdings()) {
    for (const auto& [name, network] : {std::pair{"hanging rope", rope(12, {0.6, -0.8, 0.0}, holding, {0})},
                                        {"rope between pins", rope(12, {1.0, 0.0, 0.3}, holding, {0, 7, 11})},
                                        {"cloth", cloth(holding)},
                                        {"jelly", jelly(holding)}}) {
      Simulator simulator(network, settings_of(holding, integrator()));
      run(simulator, 0.01);  // Verlet's velocity is first that of time 0, later that of half a step ago
      for (int interval = 0; interval < 3; ++interval) {
        EXPECT_LT(imbalance(simulator, 0.1), kRounding) << name << ", " << holding.name << ", interval " << interval;
      }
    }
  }
}

// Begun at rest, it ends at rest: the pin that catches the mass gives back what gravity gave. Verlet takes half a step of it
// before the start.
TEST_P(ReactionsOfScheme, APinThatCatchesAMassTakesItsMomentum) {
  NetworkBuilder builder;
  builder.add_particle({0.0, 1.0, 0.0}, 0.1);
  builder.add_pin({.particles = {0}, .motion = {}, .from = 0.2, .until = 0.4, .name = "catch"});
  Simulator simulator(builder.build(), settings_of({}, integrator()));
  run(simulator, 0.3);
  ASSERT_THAT(simulator.reactions(), ElementsAre(::testing::Field(&Reaction::name, "catch")));
  EXPECT_NEAR(simulator.reactions()[0].force.y(), 0.1 * kGravity, 0.1 * kGravity * kStep / 0.3);
  simulator.reset_forces();
  run(simulator, 0.1);
  EXPECT_NEAR(simulator.reactions()[0].force.y(), 0.1 * kGravity, 0.1 * kGravity * 1.0e-12);
  simulator.reset_forces();
  run(simulator, 0.1);
  EXPECT_EQ(simulator.reactions()[0].force, Vector3::Zero());
}

/// Passes alone leave a rope of many particles hopping within the tolerance of its limit; AllPinsTogether... judges these.
bool comes_to_rest(const Holding& holding) { return !holding.limit || holding.limit->solver != Solver::gauss_seidel; }

// The contract: within 0.1 %. A rope that begins straight and without a load oscillates about its rest; drag ends that. Newton's
// method ignores a hundred-thousandth of a displacement (kBalanced).
TEST(Reactions, AHangingMassReadsItsWeight) {
  for (const Holding& holding : holdings()) {
    for (const Index n : {2, 21}) {
      if (n > 2 && !comes_to_rest(holding)) continue;
      SimulatorSettings settings = settings_of(holding, VerletSettings{.damping = 0.02});
      Simulator simulator(rope(n, {0.0, -1.0, 0.0}, holding, {0}), settings);
      run(simulator, 4.0);
      simulator.reset_forces();
      run(simulator, 0.033);
      const Vector3 force = simulator.reactions().at(0).force;
      const double weight = mass(simulator) * kGravity;
      EXPECT_NEAR(force.y(), weight, 1.0e-3 * weight) << holding.name << ", " << n;
      EXPECT_NEAR(force.x(), 0.0, 1.0e-3 * weight) << holding.name << ", " << n;
      EXPECT_NEAR(force.z(), 0.0, 1.0e-3 * weight) << holding.name << ", " << n;
    }
  }
}

// A step projects the mass back to its circle, which takes (omega dt)^2 of its energy at most: v dt / l^2 times the way to the
// lowest point, 4.4 m/s * 1 ms * pi / 2, in all: less than 1 %, and a step beyond the lowest point another 1 %. R = m (g + v^2 /
// l), beside the weight of the pinned particle. In a step the mass turns by omega dt, by which the direction of the force and the
// place at which v is measured are uncertain: a relative error of at most 2 omega dt of m v^2 / l. The link is within the tolerance
// of its length.
TEST(Reactions, APendulumPullsAtItsLowestPointByItsWeightAndItsCentripetalForce) {
  for (const Solver solver : {Solver::gauss_seidel, Solver::newton}) {
    const Holding rigid{"rigid", StretchLimitSettings{.max_stretch = 0.0, .tolerance = 0.0, .solver = solver}};
    Simulator simulator(rope(2, {1.0, 0.0, 0.0}, rigid, {0}), settings_of(rigid));
    while (simulator.positions()(0, 1) > 0.0) {
      simulator.reset_forces();
      simulator.step();
    }
    const double m = simulator.network().masses[1];
    const double v = simulator.state().v.col(1).norm();
    EXPECT_NEAR(v * v, 2.0 * kGravity, 0.04 * kGravity);
    const double expected = 2.0 * m * kGravity + m * v * v;
    EXPECT_NEAR(simulator.reactions().at(0).force.y(), expected, 2.0 * v * kStep * m * v * v + 1.0e-3 * expected)
        << static_cast<int>(solver);
  }
}

// Moments about a pin: the other pin bears sum m g x / L of a rope between pins at one height, where the heavier half is on its
// side. The positions are those of rest within the motion that is left, 1e-3.
TEST(Reactions, TwoPinsShareTheWeightByItsLeverArms) {
  for (const Holding& holding : holdings()) {
    BodyShape shape = make_rope({.points = {Vector3::Zero(), {1.0, 0.0, 0.0}}, .particles = 11, .length = 1.2},
                                {.structural = holding.material()});
    set_total_mass(shape, 0.1);
    for (std::size_t i = 7; i < 11; ++i) shape.masses[i] *= 3.0;
    NetworkBuilder builder;
    builder.add_body("rope", shape);
    builder.pin(0);
    builder.pin(10);
    Simulator simulator(builder.build(), settings_of(holding, VerletSettings{.damping = 0.02}));
    run(simulator, 4.0);
    simulator.reset_forces();
    run(simulator, 0.033);
    const Scalars& masses = simulator.network().masses;
    const double at_second = kGravity * simulator.positions().row(0).dot(masses);
    const std::vector<Reaction> reactions = simulator.reactions();
    const double weight = kGravity * masses.sum();
    EXPECT_NEAR(reactions.at(1).force.y(), at_second, 2.0e-3 * weight) << holding.name;
    EXPECT_NEAR(reactions.at(0).force.y(), weight - at_second, 2.0e-3 * weight) << holding.name;
    EXPECT_NEAR(reactions[0].force.x(), -reactions[1].force.x(), 2.0e-3 * weight) << holding.name;
    EXPECT_LT(reactions[0].force.x(), -0.2 * weight) << holding.name;  // a flat catenary pulls its pins inwards
  }
}

TEST(Reactions, ABarBetweenTwoPinsSharesItsWeightInHalves) {
  for (const Holding& holding : holdings()) {
    Simulator simulator(rope(11, {1.0, 0.0, 0.0}, holding, {0, 10}), settings_of(holding, VerletSettings{.damping = 0.02}));
    run(simulator, 4.0);
    simulator.reset_forces();
    run(simulator, 0.033);
    const double half = 0.5 * mass(simulator) * kGravity;
    for (const Reaction& reaction : simulator.reactions()) {
      EXPECT_NEAR(reaction.force.y(), half, 1.0e-3 * half) << holding.name << ", " << reaction.name;
    }
  }
}

// Both masses have the acceleration of the pin once the rope is taut. Keyframes at the steps give it exactly to rounding, which is
// epsilon / dt^2 for positions of 1 m.
TEST(Reactions, AMovingPinAcceleratesItsOwnMassAndTheOneThatItPulls) {
  constexpr double kAcceleration = 2.0;
  Motion motion;
  for (int step = 0; step <= 600; ++step) {
    const double t = step * kStep;
    motion.keyframes.push_back({.time = t, .position = {0.5 * kAcceleration * t * t, 0.0, 0.0}});
  }
  for (const Solver solver : {Solver::gauss_seidel, Solver::newton}) {
    const Holding rigid{"rigid", StretchLimitSettings{.max_stretch = 0.0, .tolerance = 0.0, .solver = solver}};
    NetworkBuilder builder;
    builder.add_particle(Vector3::Zero(), 0.3);
    builder.add_particle({-1.0, 0.0, 0.0}, 0.1);
    builder.add_spring(0, 1, 0.0, 1.0);
    builder.pin(0, motion);
    SimulatorSettings settings = settings_of(rigid);
    settings.gravity.setZero();
    Simulator simulator(builder.build(), settings);
    run(simulator, 0.1);
    simulator.reset_forces();
    run(simulator, 0.2);
    EXPECT_NEAR(simulator.reactions().at(0).force.x(), 0.4 * kAcceleration, 1.0e-8) << static_cast<int>(solver);
  }
}

// What a cloth at rest on another one weighs, friction and springs carry to the pins of that one. The upper cloth creeps a little;
// truncation, whose impulses are not recorded, has nothing to do at rest.
TEST(Reactions, PinsBearWhatLiesOnTheirCloth) {
  const auto add = [](NetworkBuilder& builder, const std::string& name, double size, Index n, double height) {
    BodyShape shape = make_cloth(
        {.size = {size, size}, .resolution = {n, n}},
        {.structural = SpringMaterial{.value = 200.0, .damping = 0.1}, .shear = SpringMaterial{.value = 50.0, .damping = 0.02}});
    set_total_mass(shape, 0.1);
    RigidTransform pose = RigidTransform::Identity();
    pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
    pose.translation() = Vector3(0.0, height, 0.0);
    place(shape, pose);
    return builder.add_body(name, shape, {.thickness = 0.01, .friction = 0.5, .static_friction = 0.5});
  };
  NetworkBuilder builder;
  add(builder, "lower", 1.0, 9, 0.0);
  add(builder, "upper", 0.3, 5, 0.02);
  for (const Index corner : {0, 8, 72, 80}) builder.pin(corner);
  Holding holding{"springs", {}};
  Simulator simulator(builder.build(), settings_of(holding, VerletSettings{.damping = 0.01}));
  run(simulator, 3.0);
  simulator.reset_forces();
  run(simulator, 0.1);
  const double weight = mass(simulator) * kGravity;
  EXPECT_NEAR(sum_of(simulator.reactions()).y(), weight, 0.01 * weight);
}

TEST(Reactions, AreRecordedWithoutAChangeOfAnyBit) {
  const Obstacle floor{.name = "floor", .geometry = HalfSpaceGeometry{.offset = -0.2}};
  for (const Holding& holding : holdings()) {
    for (const IntegratorSettings& integrator : all_integrators()) {
      SimulatorSettings settings = settings_of(holding, integrator);
      Simulator recording(cloth(holding), settings, {floor});
      settings.record_forces = false;
      Simulator plain(cloth(holding), settings, {floor});
      for (Simulator* simulator : {&recording, &plain}) run(*simulator, 0.2);
      EXPECT_EQ(recording.positions(), plain.positions()) << holding.name << ", " << integrator.index();
      EXPECT_EQ(recording.state().v, plain.state().v) << holding.name << ", " << integrator.index();
      EXPECT_THAT(plain.reactions(), IsEmpty());
    }
  }
}

// Each spring of a hanging rope carries what is below it.
TEST(SpringTensions, AreTheWeightBelow) {
  constexpr Index kParticles = 21;
  for (const Holding& holding : holdings()) {
    if (!comes_to_rest(holding)) continue;
    Simulator simulator(rope(kParticles, {0.0, -1.0, 0.0}, holding, {0}), settings_of(holding, VerletSettings{.damping = 0.02}));
    run(simulator, 4.0);
    simulator.reset_forces();
    run(simulator, 0.033);
    const Scalars tensions = spring_tensions(simulator);
    const double weight = 0.1 * kGravity;
    for (Index s = 0; s + 1 < kParticles; ++s) {
      const double below = weight * (kParticles - 1 - s) / kParticles;
      EXPECT_NEAR(tensions[s], below, 1.0e-3 * weight) << holding.name << ", " << s;
    }
  }
}

// The rope lies on the ground, a little above which a pin and a rod hold its ends; the reading of frames asleep is that of the last
// step awake, whether all sleep or a mass beside it swings on.
TEST(Reactions, StayWhenABodySleeps) {
  const Holding springs{"springs", {}};
  BodyShape shape = make_rope({.points = {{0.0, 0.0101, 0.0}, {1.0, 0.0101, 0.0}}, .particles = 11, .length = {}},
                              {.structural = SpringMaterial{.value = 400.0, .damping = 1.0}});
  set_total_mass(shape, 0.1);
  const Obstacle hook{
      .name = "hook", .geometry = SphereGeometry{.radius = 0.1}, .rest_pose = RigidTransform(Eigen::Translation3d(1.0, 1.0, 0.0))};
  for (const bool beside_a_pendulum : {false, true}) {
    NetworkBuilder builder;
    builder.add_body("rope", shape, {.thickness = 0.01, .friction = 0.5, .static_friction = 0.5});
    builder.pin(0);
    builder.add_attachment({.particles = {10}, .second = ObstacleEnd{1}});
    if (beside_a_pendulum) {
      builder.begin_body("pendulum");
      const Index pivot = builder.add_particle({0.0, 3.0, 5.0}, 0.1);
      builder.add_spring(pivot, builder.add_particle({0.5, 3.0, 5.0}, 0.1), 400.0, 0.5, 0.0);
      builder.pin(pivot);
    }
    Simulator simulator(builder.build(), settings_of(springs, VerletSettings{.damping = 0.01}),
                        {ground({.friction = 0.5, .static_friction = 0.5}), hook});
    const auto ends = [&] { return std::array{simulator.reactions().front().force, simulator.reactions().back().force}; };
    std::array<Vector3, 2> awake;
    for (int frame = 0; frame < 300 && !testing::sleeps(simulator, 0); ++frame) {
      simulator.reset_forces();
      run(simulator, 0.02);
      if (!testing::sleeps(simulator, 0)) awake = ends();
    }
    ASSERT_TRUE(testing::sleeps(simulator, 0));
    for (int frame = 0; frame < 2; ++frame) {
      simulator.reset_forces();
      run(simulator, 0.02);
      for (std::size_t end = 0; end < 2; ++end) {
        EXPECT_GT(awake[end].y(), 0.999 * 0.1 * kGravity / 11.0);  // its own particle's weight at least
        EXPECT_LT((ends()[end] - awake[end]).norm(), 0.02 * awake[end].norm());
      }
    }
  }
}

TEST(Reactions, AreNamedInTheOrderOfThePins) {
  NetworkBuilder builder;
  for (int i = 0; i < 4; ++i) builder.add_particle({static_cast<double>(i), 0.0, 0.0}, 0.1);
  builder.pin(0);
  builder.add_pin({.particles = {1}, .motion = {}, .from = 0.5, .name = "later"});
  builder.pin(2);
  Simulator simulator(builder.build(), settings_of({}));
  simulator.pin(3);
  const auto names = [&] {
    std::vector<std::string> all;
    for (const Reaction& reaction : simulator.reactions()) all.push_back(reaction.name);
    return all;
  };
  EXPECT_THAT(names(), ElementsAre("pins[0]", "later", "pins[2]", "network.particles[3]"));
  simulator.step();
  EXPECT_NEAR(simulator.reactions()[3].force.y(), 0.1 * kGravity, 1.0e-12);
  EXPECT_EQ(simulator.reactions()[1].force, Vector3::Zero());
  simulator.release(3);
  simulator.reset_forces();
  simulator.step();
  EXPECT_EQ(simulator.reactions()[3].force, Vector3::Zero());
}

}  // namespace
}  // namespace sprung
