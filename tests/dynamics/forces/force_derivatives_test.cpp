// Derivatives of forces compared with differences of the forces.
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/contact/penalty_contact.h"
#include "dynamics/dense_matrix.h"
#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/forces/surface_air_force.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/integrators/stable_step.h"
#include "dynamics/network_bounds.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"

#include <gmock/gmock.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

/// A force, and the state at which it is evaluated. The network must outlive it.
struct Case {
  Forces forces;
  Points x;
  Points v;

  template <class F, class... Arguments>
  Case(const SpringNetwork& network, std::in_place_type_t<F>, Arguments&&... arguments)
      : x(network.positions), v(network.velocities) {
    forces.push_back(std::make_unique<F>(network, std::forward<Arguments>(arguments)...));
  }

  [[nodiscard]] Eigen::VectorXd force(const Points& positions, const Points& velocities) const {
    Points total;
    sum_forces(forces, {.x = positions, .v = velocities, .time = 0.0}, total);
    return total.reshaped();
  }

  [[nodiscard]] ForceDerivatives derivatives() const {
    ForceDerivatives result = make_derivatives(forces, static_cast<Index>(x.cols()));
    differentiate(forces, {.x = x, .v = v, .time = 0.0}, result);
    return result;
  }

  // Central differences over 2 h are off by h^2 / 6 of the third derivative and by the rounding 1e-16 F / h: for h = 1e-5, and
  // forces and their derivatives of up to 1e3, by less than 1e-6.
  static constexpr double kStep = 1.0e-5;
  static constexpr double kTolerance = 1.0e-6;

  [[nodiscard]] Eigen::MatrixXd differences_by_position() const {
    Eigen::MatrixXd result(x.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Points moved = Points::Zero(3, x.cols());
      moved(k) = kStep;
      result.col(k) = (force(x + moved, v) - force(x - moved, v)) / (2.0 * kStep);
    }
    return result;
  }

  [[nodiscard]] Eigen::MatrixXd differences_by_velocity() const {
    Eigen::MatrixXd result(x.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Points moved = Points::Zero(3, x.cols());
      moved(k) = kStep;
      result.col(k) = (force(x, v + moved) - force(x, v - moved)) / (2.0 * kStep);
    }
    return result;
  }
};

void expect_near(const BlockMatrix& matrix, const Eigen::MatrixXd& differences) {
  EXPECT_LT((dense(matrix) - differences).cwiseAbs().maxCoeff(), Case::kTolerance);
}

/// Springs between random particles, all of them stretched, or all compressed.
SpringNetwork random_springs(double rest_fraction, double damping_factor) {
  SpringNetwork network = make_random_network(12, 30, true);
  Springs& springs = network.springs;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    springs.rest_length[s] =
        rest_fraction * (network.positions.col(springs.first[s]) - network.positions.col(springs.second[s])).norm();
    springs.damping[s] *= damping_factor;
  }
  return network;
}

TEST(ForceDerivatives, OfStretchedSpringsAreTheDifferencesOfTheirForces) {
  const SpringNetwork network = random_springs(0.7, 0.0);
  const Case springs(network, std::in_place_type<SpringForce>);
  expect_near(springs.derivatives().by_position, springs.differences_by_position());
}

TEST(ForceDerivatives, OfDampersAreTheDifferencesOfTheirForces) {
  const SpringNetwork network = random_springs(0.7, 1.0);
  const Case springs(network, std::in_place_type<SpringForce>);
  expect_near(springs.derivatives().by_velocity, springs.differences_by_velocity());
}

// A spring compressed to 1 / 1.4 of its rest length pushes sideways with 0.4 of its stiffness; the derivatives leave that out.
TEST(ForceDerivatives, OfCompressedSpringsAreThoseAlongThem) {
  const SpringNetwork network = make_pair(1.0, 50.0, 1.4);
  const Case spring(network, std::in_place_type<SpringForce>);
  Eigen::MatrixXd differences = spring.differences_by_position();
  EXPECT_NEAR(differences(1, 1), 0.4 * 50.0, Case::kTolerance);
  for (const Eigen::Index sideways : {1, 2, 4, 5}) differences.row(sideways).setZero();
  expect_near(spring.derivatives().by_position, differences);
}

TEST(ForceDerivatives, OfTensionOnlySpringsAreTheDifferencesOfTheirForces) {
  for (const double rest_fraction : {0.7, 1.4}) {
    SpringNetwork network = random_springs(rest_fraction, 1.0);
    network.velocities.setZero();
    network.springs.laws.assign(static_cast<std::size_t>(network.springs.count()), {.tension_only = true});
    const Case springs(network, std::in_place_type<SpringForce>);
    expect_near(springs.derivatives().by_position, springs.differences_by_position());
    expect_near(springs.derivatives().by_velocity, springs.differences_by_velocity());
    EXPECT_EQ(dense(springs.derivatives().by_position).isZero(0.0), rest_fraction > 1.0) << "slack ones have none";
  }
}

TEST(ForceDerivatives, OfSpringsAreNeverDestabilising) {
  for (const double rest_fraction : {0.0, 0.7, 1.0, 1.4}) {
    const SpringNetwork network = random_springs(rest_fraction, 1.0);
    const ForceDerivatives derivatives = Case(network, std::in_place_type<SpringForce>).derivatives();
    for (const BlockMatrix* matrix : {&derivatives.by_position, &derivatives.by_velocity}) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(*matrix), Eigen::EigenvaluesOnly);
      // The tolerance is a few roundings of entries of up to 1e3.
      EXPECT_LE(solver.eigenvalues().maxCoeff(), 1.0e-12);
    }
  }
}

// A spring of zero length has no direction. With rest length 0 it pulls back equally in all directions; otherwise it does not pull
// yet.
TEST(ForceDerivatives, OfASpringOfNoLengthAreFinite) {
  const SpringNetwork loose = make_pair(0.0, 50.0, 0.0);
  EXPECT_EQ(Case(loose, std::in_place_type<SpringForce>).derivatives().by_position.diagonal(0), -50.0 * Matrix3::Identity());
  const SpringNetwork stiff = make_pair(0.0, 50.0, 1.0);
  EXPECT_EQ(Case(stiff, std::in_place_type<SpringForce>).derivatives().by_position.diagonal(0), Matrix3::Zero());
}

TEST(ForceDerivatives, OfAirAndGravityAreTheDifferencesOfTheirForces) {
  const SpringNetwork network = make_test_cloth(3, 10.0, 0.0);
  const Case air(network, std::in_place_type<AirDrag>, 0.3, Vector3(1.0, 2.0, 3.0));
  expect_near(air.derivatives().by_velocity, air.differences_by_velocity());
  expect_near(air.derivatives().by_position, air.differences_by_position());
  const Case gravity(network, std::in_place_type<Gravity>, Vector3(0.0, -9.81, 0.0));
  expect_near(gravity.derivatives().by_velocity, gravity.differences_by_velocity());
  expect_near(gravity.derivatives().by_position, gravity.differences_by_position());
}

/// A cloth of random shape and velocities. Faces are nearly 1 / 8 m^2, speeds some m/s.
SpringNetwork rumpled_cloth() {
  SpringNetwork network = make_test_cloth(3, 10.0, 0.0);
  const SpringNetwork random = make_random_network(network.particle_count(), 0);
  network.positions += 0.2 * random.positions;
  network.velocities = 3.0 * random.velocities;
  return network;
}

/// The derivatives by velocity are those of the force, and damp. Those by position are left out.
void expect_damping(const Case& air) {
  const ForceDerivatives derivatives = air.derivatives();
  expect_near(derivatives.by_velocity, air.differences_by_velocity());
  EXPECT_TRUE(dense(derivatives.by_position).isZero(0.0));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(derivatives.by_velocity), Eigen::EigenvaluesOnly);
  EXPECT_LE(solver.eigenvalues().maxCoeff(), 1e-13) << "the entries are below 1";
  EXPECT_LT(solver.eigenvalues().minCoeff(), -0.01);
}

// A step of 1 ms leaves the force quadratic at these speeds; one of 1 s continues it linearly beyond the expected speed, that of
// the wind, 0.5 m/s.
TEST(ForceDerivatives, OfAirOnFacesAreTheDifferencesOfItsForceByVelocity) {
  const SpringNetwork network = rumpled_cloth();
  for (const SurfaceDrag& drag :
       {SurfaceDrag{.normal = 0.8, .tangential = 0.1}, SurfaceDrag{.normal = 0.8, .tangential = 0.3, .quadratic = true},
        SurfaceDrag{.normal = 0.1, .tangential = 0.3, .quadratic = true}}) {
    for (const double step : {0.0, 1e-3, 1.0}) {
      const Case air(network, std::in_place_type<SurfaceAirForce>, drag, Wind(Vector3(0.0, 0.3, 0.4)), 0.0, step);
      expect_damping(air);
    }
  }
}

// As above, with the part that is linear at low speed.
TEST(ForceDerivatives, OfAirOnABodyWithItsOwnDragAreTheDifferencesOfItsForceByVelocity) {
  SpringNetwork network = rumpled_cloth();
  for (const double factor : {1.0, 0.1}) {
    network.velocities *= factor;
    network.bodies[0].drag = {.normal = 0.8, .tangential = 0.3};
    for (const double step : {0.0, 1e-3, 1.0}) {
      const Case air(network, std::in_place_type<SurfaceAirForce>, SurfaceDrag{}, Wind(Vector3(0.0, 0.3, 0.4)), 0.0, step);
      expect_damping(air);
    }
  }
}

/// A rope of random shape and velocities.
SpringNetwork crumpled_rope() {
  SpringNetwork network = make_test_rope(6, 10.0);
  const SpringNetwork random = make_random_network(network.particle_count(), 0);
  network.positions += 0.2 * random.positions;
  network.velocities = 3.0 * random.velocities;
  network.bodies[0].drag.line_diameter = 0.1;
  return network;
}

// As of faces: a step of 1 ms leaves the force as it is, one of 1 s continues it linearly beyond 0.5 m/s.
TEST(ForceDerivatives, OfAirOnLinesAreTheDifferencesOfItsForceByVelocity) {
  const SpringNetwork network = crumpled_rope();
  for (const double step : {0.0, 1e-3, 1.0}) {
    const Case air(network, std::in_place_type<SurfaceAirForce>, SurfaceDrag{}, Wind(Vector3(0.0, 0.3, 0.4)), 0.0, step);
    expect_damping(air);
  }
}

// Faces that do not move in the air have no direction along which it flows.
TEST(ForceDerivatives, OfStillAirOnFacesAreFinite) {
  const SpringNetwork network = make_test_cloth(3, 10.0, 0.0);
  const Case linear(network, std::in_place_type<SurfaceAirForce>, SurfaceDrag{.normal = 0.8, .tangential = 0.1}, Wind(), 0.0, 0.0);
  expect_near(linear.derivatives().by_velocity, linear.differences_by_velocity());
  const Case quadratic(network, std::in_place_type<SurfaceAirForce>, SurfaceDrag{.normal = 0.8, .quadratic = true}, Wind(), 0.0,
                       0.0);
  EXPECT_TRUE(dense(quadratic.derivatives().by_velocity).isZero(0.0));
  SpringNetwork rope = make_test_rope(4, 10.0);
  rope.bodies[0].drag.line_diameter = 0.1;
  const Case lines(rope, std::in_place_type<SurfaceAirForce>, SurfaceDrag{}, Wind(), 0.0, 0.0);
  EXPECT_TRUE(dense(lines.derivatives().by_velocity).isZero(0.0));
}

/// A particle that penetrates the gap of a tilted floor by a tenth.
struct OnTheFloor {
  explicit OnTheFloor(const Vector3& velocity, double friction)
      : obstacles({{.name = "floor",
                    .geometry = HalfSpaceGeometry{.normal = Vector3(0.6, 0.8, 0.0), .offset = 0.0},
                    .material = {.friction = friction, .static_friction = friction}}}) {
    NetworkBuilder builder;
    builder.begin_body("ball", {.thickness = 0.1, .friction = friction, .static_friction = friction});
    builder.add_particle(0.09 * Vector3(0.6, 0.8, 0.0), 0.5, velocity);
    network = builder.build();
  }
  [[nodiscard]] Case contact() { return Case(network, std::in_place_type<PenaltyContact>, obstacles, 200.0, 1.5, 1.0 / 64.0); }

  ObstacleSet obstacles;
  SpringNetwork network;
};

TEST(ForceDerivatives, OfAFrictionlessFloorAreTheDifferencesOfItsPush) {
  OnTheFloor floor(Vector3(0.3, -0.2, 0.1), 0.0);
  const Case contact = floor.contact();
  expect_near(contact.derivatives().by_position, contact.differences_by_position());
  expect_near(contact.derivatives().by_velocity, contact.differences_by_velocity());
}

TEST(ForceDerivatives, OfFrictionThatStopsAParticleAreTheDifferencesOfIt) {
  OnTheFloor floor(Vector3(0.004, -0.003, 0.001), 0.9);
  const Case contact = floor.contact();
  expect_near(contact.derivatives().by_velocity, contact.differences_by_velocity());
}

// The growth of sliding friction with the push is left out, as it is not symmetric. The derivatives along the floor are complete.
TEST(ForceDerivatives, OfSlidingFrictionAreTheDifferencesAlongTheFloor) {
  OnTheFloor floor(Vector3(2.0, -1.5, 1.0), 0.5);
  const Case contact = floor.contact();
  const Vector3 normal(0.6, 0.8, 0.0);
  const Matrix3 along = Matrix3::Identity() - normal * normal.transpose();
  const Matrix3 differences = contact.differences_by_velocity();
  EXPECT_LT((contact.derivatives().by_velocity.diagonal(0) * along - differences * along).cwiseAbs().maxCoeff(), Case::kTolerance);
  EXPECT_GT((differences * normal - normal * normal.dot(differences * normal)).norm(), 0.1)
      << "control: friction grows with the push";
}

TEST(ForceDerivatives, AreZeroWithoutContact) {
  OnTheFloor floor(Vector3(0.0, 1000.0, 0.0), 0.5);  // its damper would pull
  const ForceDerivatives derivatives = floor.contact().derivatives();
  EXPECT_EQ(derivatives.by_position.diagonal(0), Matrix3::Zero());
  EXPECT_EQ(derivatives.by_velocity.diagonal(0), Matrix3::Zero());
}

TEST(PenaltyContact, UsesObstaclePosesAtTheTimeOfEvaluation) {
  Obstacle floor{.name = "floor", .geometry = HalfSpaceGeometry{}};
  floor.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, 1.0, 0.0}}};
  const ObstacleSet obstacles({floor});
  NetworkBuilder builder;
  builder.begin_body("ball", {.thickness = 0.1});
  builder.add_particle(Vector3(0.0, 0.5, 0.0), 0.5);
  const SpringNetwork network = builder.build();
  Forces forces;
  forces.push_back(std::make_unique<PenaltyContact>(network, obstacles, 200.0, 0.0, 0.125));
  Points total;
  for (const double time : {0.5, 0.25, 0.4375}) {
    sum_forces(forces, {.x = network.positions, .v = network.velocities, .time = time}, total);
    // All numbers are powers of two except the thickness, from which the distance is subtracted: 1e-16 times 200.
    EXPECT_NEAR(total(1, 0), 200.0 * std::max(0.0, 0.1 - (0.5 - time)), 1.0e-13) << time;
  }
}

TEST(BlockMatrix, MultipliesLikeItsDenseCopy) {
  const SpringNetwork network = random_springs(0.7, 1.0);
  const Case springs(network, std::in_place_type<SpringForce>);
  const BlockMatrix matrix = springs.derivatives().by_position;
  Points product = Points::Ones(3, matrix.size());
  matrix.add_product(springs.v, 2.0, product);
  const Eigen::VectorXd velocity = springs.v.reshaped();
  const Eigen::VectorXd expected = Eigen::VectorXd::Ones(3 * matrix.size()) + 2.0 * dense(matrix) * velocity;
  EXPECT_LT((Eigen::VectorXd(product.reshaped()) - expected).cwiseAbs().maxCoeff(), 1.0e-11);
}

// Elements of three particles, such as an angle bend, have blocks between any two of them, in any order.
TEST(BlockMatrix, AcceptsBlocksOfAnyTwoParticles) {
  BlockMatrix matrix(4, {{3, 1}, {1, 3}, {0, 3}, {1, 0}});
  const Matrix3 block = (Matrix3() << 1, 2, 3, 4, 5, 6, 7, 8, 9).finished();
  matrix.add(1, 3, block);
  matrix.add(3, 1, 2.0 * block.transpose());
  matrix.add(3, 0, block);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(12, 12);
  expected.block<3, 3>(3, 9) = 3.0 * block;
  expected.block<3, 3>(9, 3) = 3.0 * block.transpose();
  expected.block<3, 3>(9, 0) = block;
  expected.block<3, 3>(0, 9) = block.transpose();
  EXPECT_EQ(dense(matrix), expected);
  matrix.set_zero();
  EXPECT_TRUE(dense(matrix).isZero(0.0));
}

/// Three particles 1 m and 2 m apart, bent by an angle [rad] at the middle.
SpringNetwork make_hinge(double angle, double damping = 0.0) {
  NetworkBuilder builder;
  const Vector3 drift(0.3, 0.2, -0.4);
  builder.add_particle(Vector3::Zero(), 1.0, drift);
  builder.add_particle(Vector3(1, 0, 0), 1.0);
  builder.add_particle(Vector3(1 + 2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0), 1.0, -2.0 * drift);
  builder.add_angle_bend(0, 1, 2, 5.0, damping);
  return builder.build();
}

TEST(ForceDerivatives, OfAngleBendsInLineAreTheDifferencesOfTheirForces) {
  const SpringNetwork network = make_hinge(0.0);
  const Case bend(network, std::in_place_type<BendingAngleForce>);
  expect_near(bend.derivatives().by_position, bend.differences_by_position());
}

// The derivatives leave out that forces rotate with their bonds. This grows with the angle: some k theta / length^2.
TEST(ForceDerivatives, OfAngleBendsNearlyInLineAreNearlyTheDifferences) {
  const SpringNetwork network = make_hinge(0.01);
  const Case bend(network, std::in_place_type<BendingAngleForce>);
  const Eigen::MatrixXd differences = bend.differences_by_position();
  EXPECT_LT((dense(bend.derivatives().by_position) - differences).norm(), 0.03 * differences.norm());
}

TEST(ForceDerivatives, OfAngleBendsAreNeverDestabilising) {
  for (const double angle : {0.0, 0.3, 1.5, 3.0, std::numbers::pi}) {
    const SpringNetwork network = make_hinge(angle, 0.5);
    const ForceDerivatives derivatives = Case(network, std::in_place_type<BendingAngleForce>).derivatives();
    for (const BlockMatrix* matrix : {&derivatives.by_position, &derivatives.by_velocity}) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(*matrix), Eigen::EigenvaluesOnly);
      EXPECT_LT(solver.eigenvalues().maxCoeff(), 1e-12 * (1.0 + solver.eigenvalues().cwiseAbs().maxCoeff())) << angle;
    }
  }
}

TEST(ForceDerivatives, OfDampedAngleBendsAreTheDifferencesOfTheirForces) {
  const SpringNetwork network = make_hinge(1.2, 0.5);
  const Case bend(network, std::in_place_type<BendingAngleForce>);
  expect_near(bend.derivatives().by_velocity, bend.differences_by_velocity());
}

// A rod fixed at two particles springs back from a bend of a quarter of a circle, in steps a hundred times as long as explicit
// schemes allow. It comes to rest straight.
TEST(ForceDerivatives, OfAngleBendsAllowLargeImplicitSteps) {
  BodyShape shape = make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = 20, .length = {}},
                              {.structural = SpringMaterial{.value = 1e4},
                               .bend = SpringMaterial{.value = 10.0},
                               .bend_model = SpringMaterials::BendModel::angle});
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rod", shape);
  builder.pin({0, 1});
  const SpringNetwork rod = builder.build();
  SimulationState state = initial_state(rod);
  for (Index i = 2; i < 20; ++i) {
    const double angle = std::numbers::pi / 2.0 * (i - 1) / 18.0;
    state.x.col(i) = state.x.col(i - 1) + Vector3(std::cos(angle), std::sin(angle), 0.0) / 19.0;
  }
  Forces forces;
  forces.push_back(std::make_unique<SpringForce>(rod));
  forces.push_back(std::make_unique<BendingAngleForce>(rod));
  const double step = 100.0 * largest_stable_step(SymplecticEulerSettings{}, spectral_bounds(rod));
  const auto integrator = make_integrator(ImplicitEulerSettings{}, rod);
  integrator->start(state, forces, step);
  for (int i = 0; i < 500; ++i) integrator->advance(state, forces, step);
  EXPECT_LT(state.x.row(1).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_NEAR(state.x(0, 19), 1.0, 0.01);
}

}  // namespace
}  // namespace sprung
