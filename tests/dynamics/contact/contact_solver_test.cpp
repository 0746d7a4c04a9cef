// Laws of the contact solver for hand-made contacts of particles, of points of triangles and of pairs of elements.
#include "dynamics/contact/contact_solver.h"

#include "dynamics/all_integrators.h"
#include "dynamics/contact/contact_constraint_set.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/state/simulation_state.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace sprung {
namespace {

constexpr double kGap = 0.01;          // [m]
constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kStep = 1.0 / 256.0;  // [s]

/// A network over the floor y <= 0 that steps with the given contacts.
class World {
 public:
  World(SpringNetwork model, double gravity, const ContactMaterial& floor = {}, const IntegratorSettings& scheme = VerletSettings{},
        double step_length = kStep, const Motion& of_floor = {})
      : dt(step_length),
        network(std::move(model)),
        obstacles({{.name = "floor", .geometry = HalfSpaceGeometry{}, .motion = of_floor, .material = floor}}),
        solver(network, obstacles),
        integrator(make_integrator(scheme, network)),
        state(initial_state(network)) {
    forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -gravity, 0.0)));
    integrator->start(state, forces, dt);
  }

  /// `again` are the contacts of patch 0 that are found after half the passes.
  void step(const std::vector<Contact>& contacts, int passes = 8, const std::vector<Contact>& again = {}) {
    const Points before = state.x;
    const Points v_before = state.v;
    integrator->advance(state, forces, dt);
    const Points advanced = state.x;
    const Slip slip_before = state.contact.slip;
    const StepMotion motion{before, v_before, slip_before, advanced, dt};
    solver.start(ObstacleFrame(obstacles, 0.0, dt), contacts, motion);
    for (int pass = 0; pass < passes; ++pass) {
      if (2 * pass == passes && !again.empty()) solver.renew({{0}, again}, motion);
      solver.project(state.x);
    }
    integrator->recover_velocities(state, forces, before, advanced, dt);
    solver.settle_velocities(motion, state, *integrator);
    solver.note_slip(motion, state);
    ++state.step;
  }

  double dt;  ///< [s]
  SpringNetwork network;
  ObstacleSet obstacles;
  ContactSolver solver;
  std::unique_ptr<Integrator> integrator;
  Forces forces;
  SimulationState state;
};

/// A body of particles without springs.
void add_body(NetworkBuilder& builder, const std::string& name, const std::vector<Vector3>& positions,
              const std::vector<double>& masses, const Vector3& velocity, const ContactMaterial& material) {
  builder.begin_body(name, material);
  for (std::size_t i = 0; i < positions.size(); ++i) builder.add_particle(positions[i], masses[i], velocity);
}

std::vector<Vector3> triangle_at(double height) { return {{0.0, height, 0.0}, {1.0, height, 0.0}, {0.0, height, 1.0}}; }

/// The plane y = 0 under a point of the first particles, found with patch 0.
Contact on_floor(const std::vector<double>& weights, Index first = 0) {
  Contact contact = particle_contact(first, 0, Vector3::Zero(), Vector3::UnitY());
  contact.count = static_cast<int>(weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    contact.particles[k] = first + static_cast<Index>(k);
    contact.weights[k] = weights[k];
  }
  contact.patch = 0;
  return contact;
}

/// Particle 3 over the triangle of particles 0, 1 and 2.
Contact over_triangle(const std::array<double, 3>& weights, const Vector3& normal = Vector3::UnitY()) {
  Contact contact;
  contact.particles = {3, 0, 1, 2};
  contact.weights = {1.0, -weights[0], -weights[1], -weights[2]};
  contact.count = 4;
  contact.normal = normal;
  return contact;
}

/// A particle rests on a floor that moves. It slipped by `slip` [m] on an obstacle; one step follows.
World after_slip(const Vector3& slip, Index obstacle, const Motion& of_floor = {}) {
  const ContactMaterial rough{.thickness = kGap, .friction = 0.5, .static_friction = 0.5};
  NetworkBuilder builder;
  add_body(builder, "ball", {{0.0, kGap, 0.0}}, {0.1}, Vector3::Zero(), rough);
  World world(builder.build(), kGravity, {.friction = 0.5, .static_friction = 0.5}, VerletSettings{}, kStep, of_floor);
  world.state.contact.slip.displacement.col(0) = slip;
  world.state.contact.slip.obstacle[0] = obstacle;
  world.step({on_floor({1.0})});
  return world;
}

// Rounding of positions of 0.01 m.
constexpr double kRounding = 1.0e-17;

TEST(FrictionThatRemembers, TakesBackATenthOfTheSlipOnItsObstacle) {
  const World world = after_slip({1.0e-5, 0.0, 0.0}, 0);
  EXPECT_NEAR(world.state.x(0, 0), -1.0e-6, kRounding);
  EXPECT_NEAR(world.state.contact.slip.displacement(0, 0), 0.9e-5, kRounding);
  EXPECT_EQ(world.state.contact.slip.obstacle[0], 0);
}

TEST(FrictionThatRemembers, KnowsNothingOfAnotherObstacle) {
  const World world = after_slip({1.0e-5, 0.0, 0.0}, 1);
  EXPECT_EQ(world.state.x(0, 0), 0.0);
  EXPECT_EQ(world.state.contact.slip.displacement(0, 0), 0.0);
}

// The floor turns x to -z about the place where the particle stands.
TEST(FrictionThatRemembers, TurnsTheSlipWithItsObstacle) {
  const World world = after_slip({1.0e-5, 0.0, 0.0}, 0, {.spin = {0.0, 90.0 / kStep, 0.0}});
  EXPECT_NEAR(world.state.x(0, 0), 0.0, kRounding);
  EXPECT_NEAR(world.state.x(2, 0), 1.0e-6, kRounding);
  EXPECT_NEAR(world.state.contact.slip.displacement(2, 0), -0.9e-5, kRounding);
}

// The first step from rest presses the particle by g dt^2 / 2 into the floor. Friction moves it by at most mu times that.
TEST(FrictionThatRemembers, StaysWithinCoulombsBound) {
  const World world = after_slip({1.0, 0.0, 0.0}, 0);
  const double bound = 0.5 * 0.5 * kGravity * kStep * kStep;
  EXPECT_NEAR(world.state.x(0, 0), -bound, kRounding);
  EXPECT_NEAR(world.state.contact.slip.displacement(0, 0), bound, kRounding);
}

TEST(FrictionThatRemembers, ForgetsWhatLeavesItsObstacle) {
  World world = after_slip({1.0e-5, 0.0, 0.0}, 0);
  world.step({});
  EXPECT_EQ(world.state.contact.slip.displacement(0, 0), 0.0);
  EXPECT_EQ(world.state.contact.slip.obstacle[0], kNone);
}

class ContactSolverLaws : public ::testing::TestWithParam<std::size_t> {
 protected:
  static IntegratorSettings scheme() { return all_integrators()[GetParam()]; }
};

INSTANTIATE_TEST_SUITE_P(Integrators, ContactSolverLaws, ::testing::Range(std::size_t{0}, all_integrators().size()));

TEST_P(ContactSolverLaws, FlatTriangleBouncesOnceHoweverManyContactsItHas) {
  const double e = 0.7;
  const double height = 0.5;
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(kGap + height), {0.1, 0.2, 0.7}, Vector3::Zero(),
           {.thickness = kGap, .restitution = e});
  World world(builder.build(), kGravity, {}, scheme());
  const std::vector<Contact> contacts{on_floor({0.2, 0.3, 0.5}), on_floor({1.0}, 0), on_floor({0.5, 0.5}, 1),
                                      on_floor({1.0}, 2),        on_floor({1.0}, 1), on_floor({0.9, 0.1})};
  Vector3 highest = Vector3::Zero();
  const double fall = std::sqrt(2.0 * height / kGravity);
  while (static_cast<double>(world.state.step) * kStep < fall * (1.0 + 1.9 * e)) {
    world.step(contacts);
    if (static_cast<double>(world.state.step) * kStep > 1.1 * fall) highest = highest.cwiseMax(world.state.x.row(1).transpose());
  }
  // Steps visit points of the parabola. One of them is within half a step of the top, and Euler starts half a step beside it. The
  // impulses end within 1e-3 of the impact.
  const double tolerance = 2.0 * kGravity * kStep * kStep / 8.0 + 2e-3 * e * e * height;
  for (const double top : highest) EXPECT_NEAR(top, kGap + e * e * height, tolerance);
}

TEST_P(ContactSolverLaws, TriangleRestsOnAnyPointsAndDoesNotJitter) {
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(kGap), {0.1, 0.2, 0.7}, Vector3::Zero(), {.thickness = kGap, .restitution = 1.0});
  World world(builder.build(), kGravity, {}, scheme());
  for (int i = 0; i < 200; ++i) {
    world.step({on_floor({1.0}, 0), on_floor({1.0}, 1), on_floor({1.0}, 2), on_floor({0.2, 0.3, 0.5}), on_floor({0.5, 0.5})});
    for (Index p = 0; p < 3; ++p) ASSERT_NEAR(world.state.x(1, p), kGap, 1.01 * kGravity * kStep * kStep) << "step " << i;
  }
}

TEST_P(ContactSolverLaws, APushOutOfTheGapAddsNoSpeed) {
  for (const std::vector<double>& weights : {std::vector<double>{1.0}, {0.4, 0.6}, {0.2, 0.3, 0.5}}) {
    NetworkBuilder builder;
    add_body(builder, "triangle", triangle_at(0.1 * kGap), {0.1, 0.2, 0.7}, Vector3::Zero(),
             {.thickness = kGap, .restitution = 1.0});
    World world(builder.build(), kGravity, {}, scheme());
    world.step({on_floor(weights)});
    double height = 0.0;
    double speed = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      height += weights[k] * world.state.x(1, static_cast<Index>(k));
      speed += weights[k] * world.state.v(1, static_cast<Index>(k));
    }
    EXPECT_NEAR(height, kGap, 1e-12);
    EXPECT_NEAR(speed, 0.0, 1e-12);
  }
}

TEST_P(ContactSolverLaws, PointOfATriangleStopsAfterItsStoppingDistance) {
  const double mu = 0.4;
  const double speed = 2.0;
  const ContactMaterial rough{.thickness = kGap, .friction = mu, .static_friction = mu};
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(kGap), {0.2, 0.2, 0.2}, {speed, 0.0, 0.0}, rough);
  World world(builder.build(), kGravity, {.friction = mu, .static_friction = mu}, scheme());
  // A contact at the centre of mass neither tilts nor rotates the triangle.
  const Contact middle = on_floor({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
  while (static_cast<double>(world.state.step) * kStep < 1.0) world.step({middle});
  const double distance = speed * speed / (2.0 * mu * kGravity);
  EXPECT_NEAR(world.state.x(0, 0), distance, 2.0 * speed * kStep);  // friction begins and ends within a step
  EXPECT_NEAR(world.state.v.col(0).norm(), 0.0, 1.01 * kGravity * kStep);
}

TEST(ContactSolver, PushIsSharedByWeightAndInverseMass) {
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(0.0), {0.1, 0.2, 0.4}, Vector3::Zero(), {.thickness = kGap});
  World world(builder.build(), 0.0);
  world.step({on_floor({0.2, 0.3, 0.5})}, 1);
  // Displacements in the ratio w_i / m_i that bring the weighted point to the gap.
  const Vector3 ratio(0.2 / 0.1, 0.3 / 0.2, 0.5 / 0.4);
  const Vector3 expected = kGap / Vector3(0.2, 0.3, 0.5).dot(ratio) * ratio;
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(world.state.x(1, i), expected[i], 1e-15);
}

TEST(ContactSolver, APushThatAnotherMakesNeedlessIsRemoved) {
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(0.0), {0.1, 0.1, 0.1}, Vector3::Zero(), {.thickness = kGap});
  World world(builder.build(), 0.0);
  Contact mirrored = on_floor({0.9, 0.1});
  std::swap(mirrored.particles[0], mirrored.particles[1]);
  world.step({on_floor({0.9, 0.1}), mirrored}, 16);
  // The smallest pushes that keep both gaps lift both ends equally. Each pass removes at least half of the error.
  for (Index i = 0; i < 2; ++i) EXPECT_NEAR(world.state.x(1, i), kGap, std::ldexp(kGap, -16));
}

// In the first pass the corner's own contact supports the corner, in the last pass the edge's does.
TEST_P(ContactSolverLaws, FrictionFollowsTheRemainingPush) {
  const double mu = 0.5;
  const auto speeds_on = [&](const std::vector<Contact>& contacts) {
    const ContactMaterial rough{.thickness = kGap, .friction = mu, .static_friction = mu};
    NetworkBuilder builder;
    add_body(builder, "triangle", triangle_at(kGap), {0.1, 0.1, 0.1}, {1.0, 0.0, 0.0}, rough);
    World world(builder.build(), kGravity, {.friction = mu, .static_friction = mu}, scheme());
    world.step(contacts, 64);
    return Eigen::Vector2d(world.state.v(0, 0), world.state.v(0, 1));
  };
  // The passes over velocities halve the remaining error each time and end when one changes at most 1e-3 of the first. So each of
  // two particles in each of two solutions is off by at most twice that.
  EXPECT_NEAR((speeds_on({on_floor({1.0}), on_floor({0.5, 0.5})}) - speeds_on({on_floor({1.0}, 0), on_floor({1.0}, 1)})).norm(),
              0.0, 8e-3 * mu * kGravity * kStep);
}

TEST_P(ContactSolverLaws, APushOutOfTheGapRemovesNoSpeed) {
  for (const std::vector<double>& weights : {std::vector<double>{1.0}, {0.4, 0.6}, {0.2, 0.3, 0.5}}) {
    const ContactMaterial rough{.thickness = kGap, .friction = 0.5, .static_friction = 0.5};
    NetworkBuilder builder;
    add_body(builder, "triangle", triangle_at(0.5 * kGap), {0.1, 0.2, 0.7}, {3.0, 0.0, -2.0}, rough);
    World world(builder.build(), 0.0, {.friction = 0.5, .static_friction = 0.5}, scheme());
    world.step({on_floor(weights)});
    Vector3 velocity = Vector3::Zero();
    for (std::size_t k = 0; k < weights.size(); ++k) velocity += weights[k] * world.state.v.col(static_cast<Index>(k));
    EXPECT_NEAR((velocity - Vector3(3.0, 0.0, -2.0)).norm(), 0.0, 1e-12);
  }
}

// A speed that is a displacement divided by the step gives back a slightly different displacement by rounding. The push that
// remains after the whole push is removed must not become negative. The steps have many lengths.
TEST(ContactSolver, AParticleThatLeavesTheGapStaysFinite) {
  const ContactMaterial rough{.thickness = kGap, .friction = 0.5, .static_friction = 0.5};
  for (int k = 1; k < 1000; ++k) {
    NetworkBuilder builder;
    add_body(builder, "ball", {{0.0, 1e-3 * k * kGap, 0.0}}, {0.1}, Vector3::Zero(), rough);
    World world(builder.build(), 0.0, {.friction = 0.5, .static_friction = 0.5}, VerletSettings{}, 1.0 / (240.0 + k % 100));
    world.step({on_floor({1.0})});
    ASSERT_TRUE(world.state.v.allFinite()) << k;
  }
}

// Friction accumulated along one surface has no component along another normal.
TEST(ContactSolver, ARenewedContactHasNoFrictionAlongItsNewNormal) {
  ContactConstraintSet<1> former;
  ContactConstraintSet<1> again;
  for (ContactConstraintSet<1>* set : {&former, &again}) {
    set->resize(1);
    set->row(0).particles = {0};
    set->row(0).obstacle = 0;
  }
  former.goal(0) = {.push = 0.3, .friction_change = {0.1, 0.0, 0.2}};
  again.row(0).normal = Vector3::UnitX();
  std::vector<Index> first_row{kNone};
  again.warm_start(former, 0, first_row);
  EXPECT_EQ(again.goal(0).push, 0.3);
  EXPECT_EQ(again.goal(0).friction_change, Vector3(0.0, 0.0, 0.2));
}

TEST(ContactSolver, ARenewedContactKeepsItsPushAndFriction) {
  const auto slide = [](bool again) {
    NetworkBuilder builder;
    const ContactMaterial rough{.thickness = kGap, .friction = 0.5, .static_friction = 0.5};
    add_body(builder, "triangle", triangle_at(0.5 * kGap), {0.1, 0.2, 0.3}, {1.0, -1.0, 0.0}, rough);
    World world(builder.build(), kGravity, {.friction = 0.5, .static_friction = 0.5});
    std::vector<Contact> contacts = {on_floor({1.0}, 1), on_floor({0.9, 0.1}), on_floor({0.4, 0.6}), on_floor({0.4, 0.6}, 1),
                                     on_floor({0.2, 0.8})};  // the last has the particles of the second
    std::swap(contacts[2].particles[0], contacts[2].particles[1]);
    std::vector<Contact> found = {on_floor({0.2, 0.3, 0.5})};  // a new contact, 1 m away
    found.front().point.y() -= 1.0;
    found.insert(found.end(), contacts.begin(), contacts.end());
    world.step(contacts, 8, again ? found : std::vector<Contact>{});
    return world.state.x;
  };
  EXPECT_EQ(slide(true), slide(false));
}

// Contacts of another patch, and pairs, do not change when contacts of one patch are found again. Each contact has its own height,
// mass and gap.
TEST(ContactSolver, RenewingOnePatchLeavesTheOthersUnchanged) {
  const auto slide = [](bool again) {
    NetworkBuilder builder;
    const ContactMaterial rough{.thickness = kGap, .friction = 0.5, .static_friction = 0.5};
    std::vector<Vector3> positions;
    for (int k = 0; k < 6; ++k) positions.emplace_back(k, 0.1 * k * kGap, 0.0);
    add_body(builder, "balls", positions, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {1.0, -1.0, 0.0}, rough);
    World world(builder.build(), kGravity, {.friction = 0.5, .static_friction = 0.5});
    Contact in_other_patch = on_floor({1.0}, 1);
    in_other_patch.patch = 1;
    in_other_patch.most_gap = 0.7 * kGap;
    Contact pair;
    pair.particles = {2, 3};
    pair.weights = {1.0, -1.0};
    pair.count = 2;
    pair.normal = Vector3::UnitY();
    const std::vector<Contact> of_first_patch{on_floor({1.0}), on_floor({0.6, 0.4}, 4)};
    world.step({of_first_patch[0], in_other_patch, of_first_patch[1], pair}, 8, again ? of_first_patch : std::vector<Contact>{});
    return world.state;
  };
  EXPECT_EQ(slide(true).x, slide(false).x);
  EXPECT_EQ(slide(true).v, slide(false).v);
}

TEST(ContactSolver, AContactThatIsNotFoundAgainIsRemoved) {
  NetworkBuilder builder;
  add_body(builder, "balls", {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {0.1, 0.1}, Vector3::Zero(), {.thickness = kGap});
  World world(builder.build(), 0.0);
  Contact in_other_patch = on_floor({1.0}, 1);
  in_other_patch.patch = 1;
  const Points before = world.state.x;
  const StepMotion motion{before, world.state.v, world.state.contact.slip, before, world.dt};
  world.solver.start(ObstacleFrame(world.obstacles, 0.0, world.dt), {on_floor({1.0}), in_other_patch}, motion);
  world.solver.renew({.patches = {0}}, motion);
  world.solver.project(world.state.x);
  EXPECT_EQ(world.state.x(1, 0), 0.0);
  EXPECT_NEAR(world.state.x(1, 1), kGap, 1e-15);
}

TEST(ContactSolver, PinnedCornersLeaveThePushToTheOthers) {
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(0.0), {0.1, 0.2, 0.4}, Vector3::Zero(), {.thickness = kGap});
  builder.pin({0, 2});
  World world(builder.build(), 0.0);
  world.step({on_floor({0.25, 0.5, 0.25}), on_floor({1.0}, 2)});
  EXPECT_EQ(world.state.x(1, 0), 0.0);
  EXPECT_EQ(world.state.x(1, 2), 0.0);
  EXPECT_NEAR(world.state.x(1, 1), kGap / 0.5, 1e-15);
  EXPECT_EQ(world.solver.pushed().size(), 1u);
}

// A contact close to the pin of a rod of 1 m lifts the other end farther, by the ratio of the lengths. The contact does nothing
// where the pin itself is within the gap, and no contact rotates the rod by more than a radian.
TEST(ContactSolver, AContactBesideAPinMovesTheFreeEndFarther) {
  const auto lift = [](double lever, double depth) {
    NetworkBuilder builder;
    add_body(builder, "rod", {{0.0, kGap - depth, 0.0}, {1.0, kGap - depth, 0.0}}, {0.1, 0.1}, Vector3::Zero(),
             {.thickness = kGap});
    builder.pin(0);
    World world(builder.build(), 0.0);
    world.step({on_floor({1.0 - lever, lever})});
    return world.state.x(1, 1) - (kGap - depth);
  };
  EXPECT_NEAR(lift(0.05, 0.002), 0.002 / 0.05, 1e-12);
  EXPECT_NEAR(lift(0.011, 0.002), 0.002 / 0.011, 1e-12);
  EXPECT_EQ(lift(0.009, 0.002), 0.0);
  EXPECT_NEAR(lift(0.02, 0.1), 1.0, 1e-12);
}

TEST(ContactSolver, ContactBetweenElementsConservesMomentum) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.1, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const ContactMaterial material{.thickness = kGap, .friction = 0.3, .static_friction = 0.5, .restitution = 0.6};
    NetworkBuilder builder;
    add_body(builder, "triangle", triangle_at(0.0), {unit(random), unit(random), unit(random)}, {0.0, unit(random), 0.0}, material);
    add_body(builder, "ball", {{0.3, 1.1 * kGap, 0.3}}, {unit(random)}, {unit(random), -5.0 * unit(random), unit(random)},
             material);
    World world(builder.build(), 0.0);
    const Vector3 momentum = world.state.v * world.network.masses;
    const double first = 0.5 * unit(random);
    const Vector3 normal = Vector3(0.1 * unit(random), 1.0, -0.1 * unit(random)).normalized();
    world.step({over_triangle({first, 0.3, 0.7 - first}, normal), over_triangle({0.2, 0.5, 0.3})});
    // Each of 16 visits rounds coordinates of up to 1 m by 1.1e-16 m. Velocities are rounded by 256 times that, for a mass of some
    // 3 kg.
    EXPECT_LT((world.state.v * world.network.masses - momentum).norm(), 1e-12);
    EXPECT_GT(world.solver.pushed().size(), 0u);
  }
}

TEST_P(ContactSolverLaws, ABallAndATriangleCollideLikeTwoBalls) {
  const double e = 0.5;
  NetworkBuilder builder;
  const ContactMaterial elastic{.thickness = kGap, .restitution = e};
  add_body(builder, "triangle", triangle_at(0.0), {0.1, 0.1, 0.1}, {0.0, 1.0, 0.0}, elastic);
  add_body(builder, "ball", {{1.0 / 3.0, kGap + 0.001, 1.0 / 3.0}}, {0.6}, {0.0, -2.0, 0.0}, elastic);
  World world(builder.build(), 0.0, {}, scheme());
  for (int i = 0; i < 3; ++i) world.step({over_triangle({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0})});
  // Central impact: the centre of mass keeps (0.3 - 1.2) / 0.9 = -1 m/s, the relative velocity of 3 m/s becomes -1.5.
  const double relative = e * 3.0;
  EXPECT_NEAR(world.state.v(1, 3), -1.0 + relative * 0.3 / 0.9, 1e-12);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(world.state.v(1, i), -1.0 - relative * 0.6 / 0.9, 1e-12);
}

TEST(ContactSolver, FrictionBetweenElementsActsOnTheirRelativeVelocity) {
  const double mu = 0.25;
  const ContactMaterial rough{.thickness = kGap, .friction = mu, .static_friction = mu};
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(0.0), {0.1, 0.1, 0.1}, {1.0, 0.0, 0.0}, rough);
  add_body(builder, "ball", {{1.0 / 3.0, kGap + 1e-3, 1.0 / 3.0}}, {0.6}, {3.0, -2.0, 0.0}, rough);
  World world(builder.build(), 0.0);
  for (int i = 0; i < 3; ++i) world.step({over_triangle({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0})});
  // The impact changes the relative velocity of 2 m/s along the normal to 0, so friction changes the tangential one by mu * 2 m/s,
  // in the ratio of inverse masses.
  const double change = mu * 2.0;
  EXPECT_NEAR(world.state.v(0, 3), 3.0 - change * 0.3 / 0.9, 1e-12);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(world.state.v(0, i), 1.0 + change * 0.6 / 0.9, 1e-12);
}

TEST(ContactSolver, ATriangleOnTheFloorIsNotPushedIntoIt) {
  const double e = 0.5;
  const ContactMaterial elastic{.thickness = kGap, .restitution = e};
  NetworkBuilder builder;
  add_body(builder, "triangle", triangle_at(kGap), {0.1, 0.1, 0.1}, Vector3::Zero(), elastic);
  add_body(builder, "ball", {{1.0 / 3.0, 2.0 * kGap + 1e-3, 1.0 / 3.0}}, {0.1}, {0.0, -2.0, 0.0}, elastic);
  World world(builder.build(), 0.0);
  for (int i = 0; i < 2; ++i) {
    world.step({on_floor({1.0}, 0), on_floor({1.0}, 1), on_floor({1.0}, 2), over_triangle({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0})}, 64);
    // The passes over velocities leave at most 1e-3 of the impact's 3 m/s.
    for (Index p = 0; p < 3; ++p) ASSERT_GE(world.state.v(1, p), -3e-3);
  }
  // The floor supports the triangle, so the ball bounces as from the floor itself.
  EXPECT_NEAR(world.state.v(1, 3), e * 2.0, 1e-2);
}

}  // namespace
}  // namespace sprung
