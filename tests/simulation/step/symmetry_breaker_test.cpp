// A push ends equilibria of bodies that stand in a line or plane, and touches nothing else.
#include "simulation/step/symmetry_breaker.h"

#include "base/parallel.h"
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace sprung::testing {
namespace {

const ContactMaterial kThick{.thickness = 0.005, .friction = 0.6, .static_friction = 0.6};

/// A frictionless floor lets every fold slide down.
const ContactMaterial kSlippery{.thickness = 0.005};

/// n particles of 5 g from the origin along `direction`, `spacing` [m] apart, joined by springs of 0.1 m.
NetworkBuilder chain_builder(Index n, const Vector3& direction, double spacing) {
  NetworkBuilder builder;
  builder.begin_body("chain", kThick);
  for (Index i = 0; i < n; ++i) builder.add_particle(i * spacing * direction, 0.005);
  for (Index i = 1; i < n; ++i) builder.add_spring(i - 1, i, 300.0, 0.1, 0.02);
  return builder;
}

/// The same, pinned at the origin.
SpringNetwork pinned_chain(Index n, const Vector3& direction, double spacing, const Motion& motion = {}) {
  NetworkBuilder builder = chain_builder(n, direction, spacing);
  builder.pin(0, motion);
  return builder.build();
}

/// A rope 2 mm above its place on a floor. Its springs are pressed to 0.09 m.
SpringNetwork rope_along_floor() {
  SpringNetwork network = chain_builder(11, Vector3::UnitX(), 0.09).build();
  network.positions.row(1).setConstant(0.012);
  return network;
}

/// A horizontal cloth of 3 x 3 particles, pressed to nine tenths of its size.
SpringNetwork pressed_cloth() {
  SpringNetwork network = cloth(3, 0.0);
  network.positions *= 0.9;
  return network;
}

SimulatorSettings settings_of(const IntegratorSettings& integrator, bool perturb) {
  SimulatorSettings settings;
  settings.step = integrator.index() == 0 ? 5.0e-5 : 2.5e-4;
  settings.integrator = integrator;
  settings.stability = StabilityCheck::warn;  // explicit Euler warns of growth that drag and dampers outweigh
  settings.perturb = perturb;
  return settings;
}

// A rope of 10 segments hangs 0.2 m above the floor. Its pin goes down to 0.1 m above the floor, waits, and comes back.
Simulator lowered_rope(const IntegratorSettings& integrator, bool perturb, const ContactSettings& contact = {}) {
  Motion motion;
  motion.keyframes = {
      {.time = 0.1}, {.time = 0.2, .position = {0.0, -1.1, 0.0}}, {.time = 1.0, .position = {0.0, -1.1, 0.0}}, {.time = 1.6}};
  Obstacle floor = ground(kThick);
  floor.rest_pose.translation() = Vector3(0.0, -1.2, 0.0);
  SimulatorSettings settings = settings_of(integrator, perturb);
  settings.air_drag = 0.2;  // of the whole rope of 1 m [kg/s]: motion relative to the air decays with 0.2 / 0.055 = 3.6 1/s
  settings.contact = contact;
  SpringNetwork network = pinned_chain(11, -Vector3::UnitY(), 0.1, motion);
  network.drag_areas.setConstant(1.0 / 11.0);
  return Simulator(std::move(network), settings, {floor});
}

// Particle i hangs below i springs. Spring k carries the 11 - k particles below it, so it is 0.1 m + (11 - k) m g / k_s long. A
// swing has lost the factor exp(-1.8 t) = 3e-8 of its 1 m after the 9.6 s since the pin came back, and the drag leaves no slower
// motion across the rope: the slowest swing has an angular frequency of 3.8 1/s, above 1.8 1/s.
TEST(SymmetryBreaker, RopeThatIsLoweredUprightHangsStraightAfterItIsLifted) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator = lowered_rope(integrator, true);
    run(simulator, 11.2);
    double height = 0.0;
    for (Index i = 0; i < 11; ++i) {
      if (i > 0) height -= 0.1 + (11 - i) * 0.005 * kGravity / 300.0;
      EXPECT_LT((simulator.positions().col(i) - Vector3(0.0, height, 0.0)).norm(), 1.0e-6)
          << "integrator " << integrator.index() << ", particle " << i;
    }
  }
}

// An inverted segment carries the ones above it: with half of the rope above its straight place, the end is far too high.
TEST(SymmetryBreaker, WithoutItTheRopeStandsOnItsHeadsForEver) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator = lowered_rope(integrator, false);
    run(simulator, 11.2);
    EXPECT_TRUE(simulator.positions().row(0).isZero(0.0)) << "integrator " << integrator.index();
    EXPECT_TRUE(simulator.positions().row(2).isZero(0.0)) << "integrator " << integrator.index();
    EXPECT_GT(simulator.positions()(1, 10), -0.9) << "integrator " << integrator.index();
  }
}

TEST(SymmetryBreaker, RopeFallsOverByPenaltyContactToo) {
  const ContactSettings penalty{.response = ContactSettings::Response::penalty, .stiffness = 1000.0, .damping = 1.0};
  for (const bool perturb : {false, true}) {
    Simulator simulator = lowered_rope(VerletSettings{}, perturb, penalty);
    run(simulator, 1.0);
    EXPECT_EQ(simulator.positions().row(0).cwiseAbs().maxCoeff() > 0.01, perturb);
  }
}

/// A cloth of 0.5 m in the x-y plane, dropped on its edge from 5 mm above its gap.
Simulator upright_cloth(const IntegratorSettings& integrator, bool perturb, std::uint64_t seed = 0) {
  BodyShape shape = make_cloth(
      {.size = {0.5, 0.5}, .resolution = {6, 6}},
      {.structural = SpringMaterial{.value = 200.0, .damping = 0.2}, .shear = SpringMaterial{.value = 100.0, .damping = 0.2}});
  set_total_mass(shape, 0.1);
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Vector3(0.0, 0.26, 0.0);
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("cloth", shape, kSlippery);
  SimulatorSettings settings = settings_of(integrator, perturb);
  settings.air_drag = 0.1;
  settings.seed = seed;
  return Simulator(builder.build(), settings, {ground(kSlippery)});
}

// Without friction and bending stiffness, no fold stays up: each particle ends on the floor, at the sum of both thicknesses.
TEST(SymmetryBreaker, ClothThatIsDroppedOnItsEdgeFallsFlat) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator = upright_cloth(integrator, true);
    run(simulator, 4.0);
    EXPECT_LT(simulator.positions().row(1).maxCoeff(), 2.0 * kSlippery.thickness + 1.0e-4) << "integrator " << integrator.index();
  }
}

// The weight of a column of the cloth, 0.16 N, shortens each of its 5 springs of 200 N/m by at most 0.8 mm, so that the centre
// sinks by less than 4 mm from 0.26 m.
TEST(SymmetryBreaker, WithoutItTheClothStandsOnItsEdgeForEver) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator = upright_cloth(integrator, false);
    run(simulator, 4.0);
    EXPECT_GT(simulator.positions().row(1).mean(), 0.256) << "integrator " << integrator.index();
    EXPECT_TRUE(simulator.positions().row(2).isZero(0.0)) << "integrator " << integrator.index();
  }
}

TEST(SymmetryBreaker, ASeedGivesTheSameBitsForAnyNumberOfThreads) {
  const auto fallen = [](std::uint64_t seed, int threads) {
    const ThreadLimit limit(threads);
    Simulator simulator = upright_cloth(VerletSettings{}, true, seed);
    run(simulator, 2.0);
    return simulator.positions();
  };
  const Points first = fallen(1, 1);
  EXPECT_EQ(first, fallen(1, 2));
  EXPECT_NE(first, fallen(2, 1));
}

/// Whether a run of 0.5 s has the same positions after each step with and without the push. The particles move.
bool has_same_bits(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, bool touches) {
  SimulatorSettings settings = settings_of(VerletSettings{}, true);
  Simulator pushed(network, settings, obstacles);
  settings.perturb = false;
  Simulator left(network, settings, obstacles);
  bool touched = false;
  for (int step = 0; step < 2000; ++step) {
    pushed.step();
    left.step();
    touched = touched || pushed.contact_count() > 0;
    if (pushed.positions() != left.positions()) return false;
  }
  EXPECT_EQ(touched, touches);
  EXPECT_NE(pushed.positions(), network.positions);
  return true;
}

TEST(SymmetryBreaker, RopeThatHangsAboveAFloorKeepsItsBits) {
  SpringNetwork network = pinned_chain(11, -Vector3::UnitY(), 0.09);
  network.positions.row(1).array() += 2.0;
  EXPECT_TRUE(has_same_bits(network, {ground()}, false));
}

TEST(SymmetryBreaker, CompressedChainWithoutContactKeepsItsBits) {
  EXPECT_TRUE(has_same_bits(pinned_chain(3, Vector3::UnitY(), 0.05), {}, false));
}

// Only the normal of the floor tells this rope from one that stands upright.
TEST(SymmetryBreaker, CompressedRopeAlongAFloorKeepsItsBits) {
  EXPECT_TRUE(has_same_bits(rope_along_floor(), {ground(kThick)}, true));
}

TEST(SymmetryBreaker, CompressedClothThatLiesOnAFloorKeepsItsBits) {
  SpringNetwork network = cloth(6, 0.012, kThick);
  network.positions.row(0) *= 0.9;
  EXPECT_TRUE(has_same_bits(network, {ground(kThick)}, true));
}

TEST(SymmetryBreaker, CompressedRopeThatTouchesAWallWithItsEndIsPushed) {
  const Obstacle wall{
      .name = "wall", .geometry = HalfSpaceGeometry{.normal = {-1.0, 0.0, 0.0}, .offset = -0.911}, .material = kThick};
  EXPECT_FALSE(has_same_bits(rope_along_floor(), {ground(kThick), wall}, true));
}

/// Velocities after one push of 1 ms at a contact of particle 2.
Points velocities_after_push(const SpringNetwork& network, const Vector3& normal) {
  SymmetryBreaker breaker(network, 0);
  SimulationState state = initial_state(network);
  breaker.push({{2, normal}}, 1.0e-3, *make_integrator(VerletSettings{}, network), state);
  return state.v;
}

// A particle moves by |v| dt in the step; 1e-15 is rounding.
TEST(SymmetryBreaker, APushIsAcrossTheLineAndAtMostABillionthOfAnEdge) {
  const Points v = velocities_after_push(pinned_chain(3, Vector3::UnitY(), 0.09), -Vector3::UnitY());
  EXPECT_TRUE(v.col(0).isZero(0.0)) << "it is pinned";
  EXPECT_TRUE(v.row(1).isZero(0.0));
  for (const Index i : {1, 2}) {
    EXPECT_GT(v.col(i).norm(), 0.0);
    EXPECT_LE(v.col(i).norm() * 1.0e-3, 1.0e-9 * 0.1 * (1.0 + 1.0e-15));
  }
}

TEST(SymmetryBreaker, APushOfAPlaneIsAlongItsNormal) {
  const Points v = velocities_after_push(pressed_cloth(), Vector3::UnitX());
  EXPECT_TRUE(v.row(0).isZero(0.0));
  EXPECT_TRUE(v.row(2).isZero(0.0));
  EXPECT_FALSE(v.row(1).isZero(0.0));
}

TEST(SymmetryBreaker, WhatIsNotCompressedGetsNoPush) {
  EXPECT_TRUE(velocities_after_push(pinned_chain(3, Vector3::UnitY(), 0.1), -Vector3::UnitY()).isZero(0.0));
}

TEST(SymmetryBreaker, ContactAcrossTheLineGivesNoPush) {
  EXPECT_TRUE(velocities_after_push(pinned_chain(3, Vector3::UnitY(), 0.09), Vector3::UnitX()).isZero(0.0));
}

// 1e-9 of the extent is far more than rounding.
TEST(SymmetryBreaker, WhatLeavesItsPlaneGetsNoPush) {
  SpringNetwork network = pressed_cloth();
  network.positions(1, 4) = 1.0e-9;
  EXPECT_TRUE(velocities_after_push(network, Vector3::UnitX()).isZero(0.0));
}

}  // namespace
}  // namespace sprung::testing
