// Laws of attachments: rods and springs between bodies, and to obstacles.
#include "base/error.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

namespace sprung {
namespace {

using testing::deforming_sheet;
using ::testing::HasSubstr;
using testing::kGravity;
using testing::momentum;
using testing::run;

constexpr double kStep = 1.0e-3;       // [s]
constexpr double kLongStep = 0x1p-7;   // [s]
constexpr double kRodLength = 1.0e-3;  // by which a rod's length may be off

/// Adds a tetrahedron of four particles of 0.1 to 0.4 kg whose edges are damped springs. It flies and spins.
void add_tetrahedron(NetworkBuilder& builder, const std::string& name, const Vector3& centre, const Vector3& velocity,
                     const Vector3& spin) {
  builder.begin_body(name);
  const std::array<Vector3, 4> corners{Vector3{0.3, 0.0, 0.0}, {-0.1, 0.28, 0.0}, {-0.1, -0.15, 0.25}, {-0.1, -0.12, -0.26}};
  std::vector<Index> particles;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    particles.push_back(
        builder.add_particle(centre + corners[k], 0.1 * static_cast<double>(k + 1), velocity + spin.cross(corners[k])));
  }
  for (std::size_t k = 0; k < particles.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l)
      builder.add_spring(particles[l], particles[k], 20.0, (corners[k] - corners[l]).norm(), 0.02);
  }
}

/// Two tetrahedra, whose particles are 0 to 3 and 4 to 7.
NetworkBuilder two_tetrahedra() {
  NetworkBuilder builder;
  add_tetrahedron(builder, "a", {0.0, 0.0, 0.0}, {0.4, -0.2, 0.1}, {1.0, 2.0, -0.5});
  add_tetrahedron(builder, "b", {0.9, 0.1, -0.05}, {-0.3, 0.5, 0.2}, {-1.5, 0.5, 1.0});
  return builder;
}

Vector3 angular_momentum(const Simulator& simulator) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < simulator.network().particle_count(); ++i) {
    sum += simulator.network().masses[i] * simulator.positions().col(i).cross(simulator.state().v.col(i));
  }
  return sum;
}

double distance(const Simulator& simulator, Index a, Index b) {
  return (simulator.positions().col(a) - simulator.positions().col(b)).norm();
}

/// The mean force of a rod on its first end in the last step [N].
Vector3 rod_force(const Simulator& simulator, std::size_t link = 0) {
  return simulator.state().links.at(link).impulse / simulator.settings().step;
}

class Attached : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static IntegratorSettings integrator() { return all_integrators()[GetParam()]; }
  [[nodiscard]] static SimulatorSettings settings(double gravity = kGravity, double step = kStep) {
    return {.step = step, .gravity = {0.0, -gravity, 0.0}, .integrator = integrator()};
  }
};

INSTANTIATE_TEST_SUITE_P(Integrators, Attached, ::testing::Range(std::size_t{0}, all_integrators().size()));

// RK4 and both other Euler schemes do not keep the angular momentum of springs.
std::vector<std::size_t> symplectic_schemes() {
  std::vector<std::size_t> schemes;
  for (std::size_t k = 0; k < all_integrators().size(); ++k) {
    const IntegratorSettings scheme = all_integrators()[k];
    if (std::holds_alternative<ExplicitEulerSettings>(scheme) || std::holds_alternative<RungeKutta4Settings>(scheme) ||
        std::holds_alternative<ImplicitEulerSettings>(scheme)) {
      continue;
    }
    schemes.push_back(k);
  }
  return schemes;
}

class AttachedSymplectically : public Attached {};

INSTANTIATE_TEST_SUITE_P(Integrators, AttachedSymplectically, ::testing::ValuesIn(symplectic_schemes()));

// Rods between particles, a rod of length 0, one that winches its ends together, and springs. A velocity of Verlet has the rounding
// of positions of some metres, 2e-16 m, divided by the step of 8 ms: 3e-14 m/s, in a random walk of 128 steps 3e-13 m/s.
TEST_P(Attached, MomentumOfFreeBodiesIsKept) {
  NetworkBuilder builder = two_tetrahedra();
  builder.add_attachment({.name = "rod", .particles = {0}, .second = ParticleEnds{{5}}});
  builder.add_attachment({.name = "winch", .particles = {1}, .second = ParticleEnds{{6}}, .rest_length = 0.0});
  builder.add_attachment(
      {.name = "spring", .particles = {2, 3}, .second = ParticleEnds{{6, 7}}, .stiffness = 15.0, .damping = 0.1});
  Simulator simulator(builder.build(), settings(0.0, kLongStep));
  const Vector3 before = momentum(simulator);
  double largest = 0.0;
  for (int step = 0; step < 128; ++step) {
    simulator.step();
    largest = std::max(largest, simulator.state().v.colwise().norm().transpose().dot(simulator.network().masses));
    ASSERT_LE((momentum(simulator) - before).norm(), 1e-12 * largest) << step;
  }
  EXPECT_GT(largest, 0.5);
}

TEST_P(AttachedSymplectically, KeepTheAngularMomentumOfFreeBodies) {
  NetworkBuilder builder = two_tetrahedra();
  builder.add_attachment({.name = "rods", .particles = {0, 1}, .second = ParticleEnds{{5, 6}}});
  builder.add_attachment({.name = "spring", .particles = {3}, .second = ParticleEnds{{7}}, .stiffness = 15.0, .damping = 0.1});
  Simulator simulator(builder.build(), settings(0.0, kLongStep));
  const Vector3 before = angular_momentum(simulator);
  double largest = 0.0;
  for (int step = 0; step < 128; ++step) {
    simulator.step();
    double sum = 0.0;
    for (Index i = 0; i < 8; ++i) {
      sum += simulator.network().masses[i] * simulator.positions().col(i).norm() * simulator.state().v.col(i).norm();
    }
    largest = std::max(largest, sum);
    ASSERT_LE((angular_momentum(simulator) - before).norm(), 1e-12 * largest) << step;
  }
}

TEST_P(Attached, RodsKeepTheDistanceAtWhichTheyEngage) {
  NetworkBuilder builder = two_tetrahedra();
  builder.add_attachment({.name = "rods", .particles = {0, 1, 2, 3}, .second = ParticleEnds{{4, 5, 6, 7}}});
  Simulator simulator(builder.build(), settings(0.0));
  const std::vector<Link> links = simulator.state().links;
  ASSERT_EQ(links.size(), 4U);
  for (int step = 0; step < 500; ++step) {
    simulator.step();
    for (const Link& link : links)
      ASSERT_NEAR(distance(simulator, link.first, link.second[0]), link.distance, kRodLength * link.distance) << step;
  }
}

TEST_P(Attached, EachParticleTakesTheNearestOfTheSecondEnds) {
  NetworkBuilder builder;
  for (const double x : {0.0, 1.0}) builder.add_particle({x, 0.0, 0.0}, 0.1);
  builder.begin_body("other");
  for (const double x : {1.1, 0.2, 3.0}) builder.add_particle({x, 0.5, 0.0}, 0.1);
  builder.add_attachment({.name = "seam", .particles = {0, 1}, .second = ParticleEnds{{2, 3, 4}}});
  const Simulator simulator(builder.build(), settings());
  ASSERT_EQ(simulator.state().links.size(), 2U);
  EXPECT_EQ(simulator.state().links[0].second[0], 3);
  EXPECT_EQ(simulator.state().links[1].second[0], 2);
}

// The weight hangs below the inside of a face of the cloth: 0.2 of a cell's side along x and 0.1 along z from its corner.
TEST_P(Attached, ARodToAFaceKeepsItsDistanceFromThePointOfTheFace) {
  const double height = 2.0;
  NetworkBuilder builder;
  BodyShape shape = make_cloth(
      {.size = {1.0, 1.0}, .resolution = {5, 5}},
      {.structural = SpringMaterial{.value = 200.0, .damping = 0.4}, .shear = SpringMaterial{.value = 100.0, .damping = 0.2}});
  set_total_mass(shape, 0.2);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  pose.translation() = Vector3(0.0, height, 0.0);
  place(shape, pose, Vector3::Zero());
  builder.add_body("cloth", shape);
  builder.pin(std::vector<Index>{0, 4, 20, 24});
  builder.begin_body("weight");
  const Vector3 below(0.05, height - 0.3, 0.025);
  const Index weight = builder.add_particle(below, 0.05);
  builder.add_attachment({.name = "cord", .particles = {weight}, .second = SurfaceEnd{0}});
  Simulator simulator(builder.build(), settings());
  const Link link = simulator.state().links.at(0);
  const auto point = [&] {
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k) sum += link.weights[static_cast<Index>(k)] * simulator.positions().col(link.second[k]);
    return sum;
  };
  EXPECT_LE((point() - Vector3(below.x(), height, below.z())).norm(), 1e-12);
  for (int step = 0; step < 1000; ++step) {
    simulator.step();
    ASSERT_NEAR((simulator.positions().col(weight) - point()).norm(), 0.3, kRodLength * 0.3);
  }
  EXPECT_LT(point().y(), height - 0.01) << "the weight pulls the face down";
}

Obstacle beam() {
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Vector3(0.0, 2.0, 0.0);
  return {.name = "beam", .geometry = BoxGeometry{{1.0, 0.2, 0.2}}, .rest_pose = pose};
}

/// A rope of five particles of 0.02 kg and 0.2 m springs below the beam, with a weight of 0.1 kg at its end.
NetworkBuilder rope_with_weight() {
  NetworkBuilder builder;
  for (int i = 0; i < 5; ++i) builder.add_particle({0.0, 1.85 - 0.2 * i, 0.0}, i < 4 ? 0.02 : 0.12);
  for (Index i = 0; i < 4; ++i) builder.add_spring(i, i + 1, 1000.0, 0.2, 2.0);
  return builder;
}

// The springs stretch in series by F / 250 N/m, with 0.12 kg and a third of the rope's mass at their end: this oscillation decays
// at the rate c / 2 m = 0.5 / 0.29 = 1.7/s, of which explicit Euler takes back k dt / 2 m = 0.85/s. 9 s leave less than 5e-4 of it.
TEST_P(Attached, ARopeOnAnObstacleCarriesItsWeight) {
  for (const std::optional<double> stiffness : {std::optional<double>{}, std::optional(2000.0)}) {
    NetworkBuilder builder = rope_with_weight();
    builder.add_attachment(
        {.name = "hook", .particles = {0}, .second = ObstacleEnd{0}, .stiffness = stiffness, .damping = stiffness ? 4.0 : 0.0});
    SimulatorSettings recorded = settings();
    recorded.record_forces = true;
    Simulator simulator(builder.build(), recorded, {beam()});
    run(simulator, 9.0);
    const double weight = 0.2 * kGravity;
    simulator.reset_forces();
    run(simulator, 0.1);
    ASSERT_EQ(simulator.reactions().size(), 1U);
    EXPECT_EQ(simulator.reactions()[0].name, "hook");
    EXPECT_LE((simulator.reactions()[0].force - Vector3(0.0, weight, 0.0)).norm(), 1e-3 * weight);
    if (stiffness) {
      EXPECT_NEAR(simulator.positions()(1, 0), 1.85 - weight / *stiffness, 1e-3 * weight / *stiffness);
    } else {
      EXPECT_NEAR(simulator.positions()(1, 0), 1.85, kRodLength * 0.05);
      EXPECT_LE((rod_force(simulator) - Vector3(0.0, weight, 0.0)).norm(), 1e-3 * weight);
    }
  }
}

// Stiff springs in long steps: what a rod pulls at in one step is not the particle at its end, but all that hangs on it.
TEST(ImplicitAttachments, ARodCarriesAStiffRopeInLongSteps) {
  NetworkBuilder builder;
  for (int i = 0; i < 20; ++i) builder.add_particle({0.0, 1.85 - 0.05 * i, 0.0}, 1e-3);
  for (Index i = 0; i < 19; ++i) builder.add_spring(i, i + 1, 1e5, 0.05);
  builder.begin_body("weight");
  builder.add_particle({0.0, 1.85 - 0.05 * 20, 0.0}, 1.0);
  builder.add_attachment({.name = "hook", .particles = {0}, .second = ObstacleEnd{0}});
  builder.add_attachment({.name = "knot", .particles = {19}, .second = ParticleEnds{{20}}});
  Simulator simulator(builder.build(), {.step = 1.0 / 60.0, .integrator = ImplicitEulerSettings{}}, {beam()});
  run(simulator, 2.0);
  const double weight = 1.0 * kGravity;
  EXPECT_NEAR(simulator.positions()(1, 0), 1.85, kRodLength * 0.05);
  EXPECT_NEAR(distance(simulator, 19, 20), 0.05, kRodLength * 0.05);
  // Nineteen springs stretch by less than 1.02 F / k each.
  EXPECT_NEAR(simulator.positions()(1, 19), 1.85 - 0.95 - 19 * weight / 1e5, 0.02 * 19 * weight / 1e5);
  EXPECT_NEAR(rod_force(simulator, 0).y(), 1.02 * kGravity, 1e-3 * weight);
  EXPECT_NEAR(rod_force(simulator, 1).y(), -weight, 1e-3 * weight);
}

// The spring to a pin that moves down at 0.1 m/s pulls with 0.1 N/s k: the load is m g + k v t.
TEST_P(Attached, ALinkBreaksAtItsForceUnderAGrowingLoad) {
  for (const std::optional<double> stiffness : {std::optional<double>{}, std::optional(2000.0)}) {
    NetworkBuilder builder;
    builder.add_particle({0.0, 1.5, 0.0}, 0.1);
    builder.add_particle({0.0, 1.0, 0.0}, 0.1);
    builder.add_spring(0, 1, 20.0, 0.5, 0.5);
    builder.pin(1, {.keyframes = {{.time = 0.0}, {.time = 10.0, .position = {0.0, -1.0, 0.0}}}});
    builder.add_attachment({.name = "thread",
                            .particles = {0},
                            .second = ObstacleEnd{0},
                            .stiffness = stiffness,
                            .damping = stiffness ? 5.0 : 0.0,
                            .break_force = 3.0});
    Simulator simulator(builder.build(), settings(), {beam()});
    while (simulator.broken_links().empty() && simulator.time() < 3.0) simulator.step();
    ASSERT_EQ(simulator.broken_links().size(), 1U);
    EXPECT_EQ(simulator.broken_links()[0].attachment, "thread");
    EXPECT_EQ(simulator.broken_links()[0].step, simulator.state().step);
    // m g + k v t + c v = 3 N, but that the spring of the attachment yields by F / 2000 N/m: less than 1 % of k's stretch.
    const double expected = (3.0 - 0.1 * kGravity - 0.5 * 0.1) / (20.0 * 0.1);
    EXPECT_NEAR(simulator.time(), expected, 0.02 * expected);
    const Vector3 where = simulator.positions().col(0);
    run(simulator, 0.05);
    EXPECT_LT(simulator.positions()(1, 0), where.y() - 0.01);
    EXPECT_EQ(simulator.broken_links().size(), 1U);
  }
}

// A fall of n steps from rest differs from 1/2 g t^2 by up to n steps of half a step's gravity.
TEST_P(Attached, WhatABrokenLinkHeldFallsFreely) {
  NetworkBuilder builder;
  builder.add_particle({0.0, 1.5, 0.0}, 0.1);
  builder.add_attachment({.name = "thread", .particles = {0}, .second = ObstacleEnd{0}, .break_force = 0.45 * 0.1 * kGravity});
  Simulator simulator(builder.build(), settings(), {beam()});
  for (int step = 0; step < 3; ++step) simulator.step();
  ASSERT_EQ(simulator.broken_links().size(), 1U);
  const Vector3 where = simulator.positions().col(0);
  const Vector3 velocity = simulator.state().v.col(0);
  run(simulator, 0.3);
  EXPECT_NEAR(simulator.positions()(1, 0), where.y() + 0.3 * velocity.y() - 0.5 * kGravity * 0.09, kGravity * 0.3 * kStep);
}

// A particle at 1 m/s takes a rod of 1 m across its path, goes round its end, and leaves it on a straight line.
TEST_P(Attached, RodsTakeAndLeaveABodyWithoutAJerk) {
  NetworkBuilder builder;
  builder.add_particle({-0.2, 0.9, 0.0}, 0.1, {1.0, 0.0, 0.0});
  builder.add_attachment({.name = "rod", .particles = {0}, .second = ObstacleEnd{0}, .from = 0.2004, .until = 0.6996});
  Simulator simulator(builder.build(), settings(0.0), {beam()});
  run(simulator, 0.2);
  EXPECT_TRUE(simulator.state().links.empty());
  EXPECT_NEAR(simulator.positions()(0, 0), 0.0, 1e-12);
  Vector3 velocity = simulator.state().v.col(0);
  // On a circle of radius 1 m at 1 m/s the velocity turns by 1 mrad in a step.
  for (int step = 0; step < 500; ++step) {
    simulator.step();
    ASSERT_LE((simulator.state().v.col(0) - velocity).norm(), 1.1 * kStep) << step;
    velocity = simulator.state().v.col(0);
    ASSERT_NEAR(velocity.norm(), 1.0, 1e-5) << step;
    ASSERT_NEAR((simulator.positions().col(0) - Vector3(0.0, 1.9, 0.0)).norm(), 1.0, kRodLength) << step;
  }
  for (int step = 0; step < 100; ++step) {
    simulator.step();
    // The rounding of positions of 1 m, 2e-16 m, in a step of 1 ms.
    ASSERT_LE((simulator.state().v.col(0) - velocity).norm(), 1e-10) << step;
  }
  EXPECT_TRUE(simulator.state().links.empty());
}

// The smooth step from 0 to 1 in T = 0.25 s has the largest second derivative 6 / T^2, and here the length shrinks by 0.5 m.
TEST_P(Attached, AWinchComesToItsLengthWithoutAJerk) {
  NetworkBuilder builder;
  builder.add_particle({0.0, 1.0, 0.0}, 0.1);
  builder.add_attachment({.name = "winch", .particles = {0}, .second = ObstacleEnd{0}, .rest_length = 0.4, .from = 0.1});
  Simulator simulator(builder.build(), settings(0.0), {beam()});
  Vector3 velocity = Vector3::Zero();
  for (int step = 0; step < 500; ++step) {
    simulator.step();
    ASSERT_LE((simulator.state().v.col(0) - velocity).norm(), 1.01 * 6.0 / (0.25 * 0.25) * 0.5 * kStep) << step;
    velocity = simulator.state().v.col(0);
  }
  EXPECT_NEAR(simulator.positions()(1, 0), 1.5, kRodLength * 0.4);
}

Obstacle turning_ball() {
  RigidTransform placed = RigidTransform::Identity();
  placed.linear() = rotation_from_degrees({10.0, 20.0, 30.0});
  placed.translation() = Vector3(0.5, -2.0, 0.25);
  return {.name = "ball",
          .geometry = SphereGeometry{0.1},
          .rest_pose = placed,
          .motion = {.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {1.0, 0.0, 0.5}, .rotation = {40.0, 50.0, 60.0}}},
                     .interpolation = Interpolation::smooth,
                     .spin = {30.0, -60.0, 70.0}}};
}

TEST_P(Attached, ARodFollowsThePointOfARigidObstacle) {
  for (const double from : {0.0, 0.25}) {
    NetworkBuilder builder;
    builder.add_particle({0.5, -1.5, 0.3}, 0.1);
    builder.add_attachment({.name = "leash", .particles = {0}, .second = ObstacleEnd{0}, .from = from});
    Simulator simulator(builder.build(), settings(0.0), {turning_ball()});
    const Obstacle& ball = simulator.obstacles()[0];
    const auto pose = [&] { return ball.motion.pose(ball.rest_pose, simulator.time()); };
    run(simulator, from);
    const Vector3 local = pose().inverse() * Vector3(simulator.positions().col(0));
    const Vector3 anchor = 0.1 * local.normalized();
    const double length = (local - anchor).norm();
    while (simulator.time() < from + 0.5) {
      simulator.step();
      ASSERT_NEAR((simulator.positions().col(0) - pose() * anchor).norm(), length, kRodLength * length) << simulator.time();
    }
  }
}

// Vertices move on straight lines, so at time t the sheet is that of the map (1 - t) I + t M.
TEST_P(Attached, ARodFollowsThePointOfADeformingObstacle) {
  const Matrix3 map = (Matrix3() << 1.5, 0.0, 0.2, 0.7, 1.0, -0.3, 0.1, 0.0, 0.8).finished();
  NetworkBuilder builder;
  builder.add_particle({0.3, 0.5, 0.6}, 0.1);
  builder.add_attachment({.name = "leash", .particles = {0}, .second = ObstacleEnd{0}});
  Simulator simulator(builder.build(), settings(0.0), {deforming_sheet(map)});
  while (simulator.time() < 0.5) {
    simulator.step();
    const double t = simulator.time();
    const Vector3 anchor = ((1.0 - t) * Matrix3::Identity() + t * map) * Vector3(0.3, 0.0, 0.6);
    ASSERT_NEAR((simulator.positions().col(0) - anchor).norm(), 0.5, kRodLength * 0.5) << t;
  }
}

// A change between steps builds the simulator anew; the links must be those of before.
TEST_P(Attached, AChangeOfTheSimulatorDoesNotDisturbAttachments) {
  NetworkBuilder builder = two_tetrahedra();
  builder.add_attachment({.name = "rod", .particles = {0}, .second = ParticleEnds{{5}}, .from = 0.05, .until = 0.3});
  builder.add_attachment({.name = "spring", .particles = {3}, .second = ParticleEnds{{7}}, .stiffness = 15.0, .damping = 0.1});
  builder.add_attachment({.name = "thread", .particles = {1}, .second = ParticleEnds{{6}}, .break_force = 1e-6});
  Simulator whole(builder.build(), settings(0.0));
  Simulator changed(builder.build(), settings(0.0));
  for (int k = 0; k < 4; ++k) {
    run(whole, 0.1);
    run(changed, 0.1);
    changed.continue_with(changed.network(), changed.settings());
    EXPECT_EQ(changed.positions(), whole.positions()) << k;
    EXPECT_EQ(changed.broken_links().size(), 1U);
  }
}

// Links that hold or broke stay as they are.
TEST(Attachments, WhatAChangeAddsEngagesAtTheNextStep) {
  NetworkBuilder builder = two_tetrahedra();
  builder.add_attachment({.name = "rods", .particles = {0}, .second = SurfaceEnd{1}});
  builder.add_attachment({.name = "thread", .particles = {1}, .second = ParticleEnds{{6}}, .break_force = 1e-6});
  Simulator simulator(builder.build());
  run(simulator, 0.1);
  const std::vector<Link> before = simulator.state().links;
  ASSERT_TRUE(before.at(1).broken.has_value());

  SpringNetwork network = simulator.network();
  network.attachments[0].particles = {0, 2};
  network.attachments.push_back({.name = "new", .particles = {3}, .second = ParticleEnds{{7}}});
  simulator.continue_with(network, simulator.settings());
  const double distance_before = distance(simulator, 3, 7);
  const double time = simulator.time();
  run(simulator, 0.1);
  const std::vector<Link>& links = simulator.state().links;
  ASSERT_EQ(links.size(), 4U);
  EXPECT_EQ(links[0].first, 0);
  EXPECT_EQ(links[0].time, 0.0);
  EXPECT_EQ(links[1].first, 2);
  EXPECT_EQ(links[1].time, time);
  EXPECT_EQ(links[2].broken, before[1].broken);
  EXPECT_EQ(links[3].time, time);
  EXPECT_NEAR(distance(simulator, 3, 7), distance_before, kRodLength * distance_before);
}

// Two particles of masses m and M on a spring: omega^2 = k (1 / m + 1 / M).
TEST(Attachments, TheirSpringsBoundTheStep) {
  const double largest = 2.0 / std::sqrt(1000.0 * (1.0 / 0.1 + 1.0 / 0.3));
  const auto start = [&](double step, double from) {
    NetworkBuilder builder;
    builder.add_particle({0.0, 0.0, 0.0}, 0.1);
    builder.begin_body("other");
    builder.add_particle({1.0, 0.0, 0.0}, 0.3);
    builder.add_attachment({.name = "spring", .particles = {0}, .second = ParticleEnds{{1}}, .stiffness = 1000.0, .from = from});
    const Simulator simulator(builder.build(), {.step = step, .integrator = SymplecticEulerSettings{}});
  };
  for (const double from : {0.0, 1.0}) {
    EXPECT_NO_THROW(start(0.98 * largest, from));
    EXPECT_THROW(start(1.02 * largest, from), InputError);
  }
}

TEST(Attachments, AMissingObstacleIsAProblem) {
  NetworkBuilder builder;
  builder.add_particle({0.0, 1.5, 0.0}, 0.1);
  builder.add_attachment({.name = "hook", .particles = {0}, .second = ObstacleEnd{1}});
  try {
    const Simulator simulator(builder.build(), {}, {beam()});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].key, "attachments[0].second.obstacle");
    EXPECT_THAT(error.problems()[0].rule, HasSubstr("there are 1"));
  }
}

TEST(Attachments, ALengthBelowTheGapOfContactIsWarnedOf) {
  const auto warnings = [](std::optional<double> rest_length) {
    NetworkBuilder builder;
    builder.begin_body("left", {.thickness = 0.02});
    builder.add_particle({0.0, 0.0, 0.0}, 0.1);
    builder.begin_body("right", {.thickness = 0.01});
    builder.add_particle({0.1, 0.0, 0.0}, 0.1);
    builder.add_attachment({.name = "attachments[0]", .particles = {0}, .second = ParticleEnds{{1}}, .rest_length = rest_length});
    return Simulator(builder.build()).warnings();
  };
  EXPECT_THAT(warnings({}), ::testing::IsEmpty());
  EXPECT_THAT(warnings(0.015), ::testing::IsEmpty());
  EXPECT_THAT(warnings(0.014),
              ::testing::ElementsAre(HasSubstr("attachments[0]: rest_length = 0.014 is below the gap of 0.015 m that contact keeps "
                                               "between body \"left\" and body \"right\"")));
}

TEST(Attachments, ALengthFarBeyondTheDistanceIsWarnedOf) {
  const auto warnings = [](std::optional<double> rest_length) {
    NetworkBuilder builder = two_tetrahedra();
    builder.add_attachment({.name = "rods", .particles = {0, 1, 2}, .second = SurfaceEnd{1}, .rest_length = rest_length});
    return Simulator(builder.build(), {.gravity = Vector3::Zero()}).warnings();
  };
  for (const std::optional<double> usual : {std::optional<double>{}, {0.0}, {1e-4}, {2.0}}) {
    EXPECT_THAT(warnings(usual), ::testing::IsEmpty());
  }
  EXPECT_THAT(warnings(1e6), ::testing::ElementsAre(HasSubstr("rods: rest_length = 1e+06 is more than 100 times the distance")));
}

}  // namespace
}  // namespace sprung
