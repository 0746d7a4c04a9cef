#include "dynamics/stretch_newton/stretch_newton.h"

#include "base/parallel.h"
#include "dynamics/dense_matrix.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "dynamics/stretch_newton/component_newton.h"
#include "dynamics/stretch_newton/pcg_solver.h"
#include "dynamics/stretch_newton/stretch_energy.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <tuple>

namespace sprung {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kGravity = 9.81;

Scalars random_displacement(std::mt19937& random, Index size, double most) {
  std::uniform_real_distribution<double> between(-most, most);
  return Scalars::NullaryExpr(size, [&] { return between(random); });
}

SpringNetwork tree_with_two_pins() {
  NetworkBuilder builder;
  std::mt19937 random(5);
  for (Index i = 0; i < 40; ++i) {
    const Vector3 position = random_displacement(random, 3, 1.0);
    builder.add_particle(position, i % 3 == 0 ? 1.0 : 1000.0);
    if (i > 0) builder.add_spring(static_cast<Index>(random() % static_cast<unsigned>(i)), i, 0.0, 0.2);
  }
  builder.pin(39);
  builder.pin(38);
  return builder.build();
}

class Solvers : public ::testing::TestWithParam<SpringNetwork> {};
INSTANTIATE_TEST_SUITE_P(Networks, Solvers,
                         ::testing::Values(make_test_rope(30, 0.0), tree_with_two_pins(), make_test_cloth(6, 0.0, 0.0)));

// Elimination is backward stable: the error is a few roundings times the condition number, which M + K bounds by 1 + |K| / least
// mass. Other solvers may leave a tenth of the first step, measured by M + K.
TEST_P(Solvers, AgreeWithADenseSolver) {
  const SpringNetwork& network = GetParam();
  std::mt19937 random(3);
  for (StretchComponent& component : stretch_components(network, {SpringKind::structural})) {
    StretchEnergy energy(component, {.max_stretch = 0.0});
    energy.set_load(1.0e-3 * network.masses.sum());
    Points x(3, component.points.size());
    for (Index i = 0; i < x.cols(); ++i) x.col(i) = network.positions.col(component.points[i]);
    x.reshaped() += random_displacement(random, static_cast<Index>(x.size()), 0.01);
    Points target = x;
    target.reshaped() += random_displacement(random, static_cast<Index>(x.size()), 0.01);
    StretchSystem system;
    energy.linearise(x, target, NearLimit::slack, system);
    const Eigen::MatrixXd matrix = dense(component, system);
    const Scalars expected = matrix.ldlt().solve(Scalars(system.residual.reshaped()));
    Points step;
    const auto solver = make_system_solver(component);
    solver->solve(system, step);
    const Scalars error = step.reshaped() - expected;
    if (component.is_tree) {
      const double condition = matrix.norm() / *std::ranges::min_element(component.masses);
      EXPECT_LT(error.norm(), 100 * kEpsilon * condition * expected.norm());
    } else {
      EXPECT_LT(error.dot(matrix * error), 0.01 * expected.dot(matrix * expected));
    }
  }
}

// Central differences of E, whose second derivatives change by less than k / L: an error of k h^2 / L.
TEST_P(Solvers, ResidualIsTheNegativeGradient) {
  const SpringNetwork& network = GetParam();
  std::mt19937 random(4);
  const StretchComponent component = stretch_components(network, {SpringKind::structural}).front();
  StretchEnergy energy(component, {.max_stretch = 0.0});
  energy.set_load(1.0e-3);
  Points x(3, component.points.size());
  for (Index i = 0; i < x.cols(); ++i) x.col(i) = 1.05 * network.positions.col(component.points[i]);
  Points target = x;
  target.reshaped() += random_displacement(random, static_cast<Index>(x.size()), 0.01);
  StretchSystem system;
  const double value = energy.linearise(x, target, NearLimit::slack, system);
  EXPECT_NEAR(value, energy.value(x, target), 100 * kEpsilon * value);
  const double h = 1.0e-6;
  for (Index c = 0; c < 3 * component.free_count; ++c) {
    Points ahead = x;
    Points behind = x;
    ahead.reshaped()[c] += h;
    behind.reshaped()[c] -= h;
    const double slope = (energy.value(ahead, target) - energy.value(behind, target)) / (2.0 * h);
    EXPECT_NEAR(system.residual.reshaped()[c], -slope, 1.0e-6 * system.residual.norm()) << c;
  }
}

/// The target of one step of a network from rest, or from `velocities`.
Points target_of_gravity(const SpringNetwork& network, const Points& before, const Points& velocities, double dt) {
  Points target = before;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_fixed(i)) target.col(i) += dt * velocities.col(i) - kGravity * dt * dt * Vector3::UnitY();
  }
  return target;
}

/// A cloth whose links are all too long, slightly differently each time.
class StretchedCloth {
 public:
  Points next() {
    Points target = 1.3 * network.positions;
    target.reshaped() += random_displacement(random_, static_cast<Index>(target.size()), 1.0e-3);
    return target;
  }
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0, false);

 private:
  std::mt19937 random_{11};
};

// A factor serves the next step too, whose bits then depend on it. The same steps give the same bits.
TEST(StretchNewton, TheSameStepsHaveTheSameBits) {
  const auto after_steps = [] {
    StretchedCloth cloth;
    StretchNewton newton(cloth.network, {.max_stretch = 0.0, .solver = StretchLimitSettings::Solver::newton});
    Points x;
    for (int step = 0; step < 5; ++step) {
      x = cloth.next();
      EXPECT_GT(newton.solve(cloth.network.positions, x, 1.0e-3), 0);
    }
    return x;
  };
  EXPECT_EQ(after_steps(), after_steps());
}

// Each solve leaves at most a tenth of the residual, measured by M + K, so its result is as near to that of a new factor. The
// second and third systems are similar to the first; the fourth has a thousand times the load and is not.
TEST(PcgSolver, OldFactorsAreAccurateEnough) {
  StretchedCloth cloth;
  const StretchComponent component = stretch_components(cloth.network, {SpringKind::structural}).front();
  StretchEnergy energy(component, {.max_stretch = 0.0});
  PcgSolver used(component);
  for (const double load : {1.0, 1.0, 1.0, 1000.0}) {
    energy.set_load(load);
    const Points x = cloth.next();
    Points points(3, component.free_count);
    for (Index i = 0; i < component.free_count; ++i) points.col(i) = x.col(component.points[i]);
    StretchSystem system;
    energy.linearise(points, points, NearLimit::slack, system);
    system.is_like_last = true;
    Points step;
    used.solve(system, step);
    const Eigen::MatrixXd matrix = dense(component, system);
    const Scalars exact = matrix.ldlt().solve(Scalars(system.residual.reshaped()));
    const auto size = [&](const Scalars& of) { return std::sqrt(of.dot(matrix * of)); };
    EXPECT_LT(size(step.reshaped() - exact), 0.15 * size(exact)) << load;
  }
}

// Preconditioned by a factor of M + K, the eigenvalues of M + 16 K lie between 1 and 16. Conjugate gradients then leave three
// fifths of the residual in each iteration, and a tenth after six; steepest descent leaves fifteen seventeenths. The returned
// remaining gain is half of the squared residual before the last iteration, in the old factor's norm: at least the true gain and
// at most sixteen times it. A new factor leaves less than a ten-thousandth.
TEST(PcgSolver, OldFactorsPreconditionConjugateGradients) {
  StretchedCloth cloth;
  const StretchComponent component = stretch_components(cloth.network, {SpringKind::structural}).front();
  Points points(3, component.points.size());
  const Points x = cloth.next();
  for (Index i = 0; i < points.cols(); ++i) points.col(i) = x.col(component.points[i]);
  StretchEnergy energy(component, {.max_stretch = 0.0});
  StretchSystem system;
  const auto of_load = [&](double load) {
    energy.set_load(load);
    energy.linearise(points, points, NearLimit::slack, system);
  };
  PcgSolver used(component);
  Points step;
  of_load(1.0);
  used.solve(system, step);
  of_load(16.0);
  system.is_like_last = true;
  const double left = used.solve(system, step);
  const Eigen::MatrixXd matrix = dense(component, system);
  const Scalars now = system.residual.reshaped();
  const Scalars exact = matrix.ldlt().solve(now);
  const Scalars missed = step.reshaped() - exact;
  Points by_new_factor;
  PcgSolver(component).solve(system, by_new_factor);
  EXPECT_NE(step, by_new_factor) << "the old factor was not used";
  EXPECT_LE(0.5 * missed.dot(matrix * missed), left);
  EXPECT_LE(left, 0.01 * 16.0 * 0.5 * now.dot(exact));
}

// A factor of M + K overestimates the remaining gain of M + 16 K by up to sixteen times. If all of it may be left, the first
// iteration is the last. If nothing may be left, iterations continue to a hundredth.
TEST(PcgSolver, OldFactorsLeaveThePermittedError) {
  StretchedCloth cloth;
  const StretchComponent component = stretch_components(cloth.network, {SpringKind::structural}).front();
  Points points(3, component.points.size());
  const Points x = cloth.next();
  for (Index i = 0; i < points.cols(); ++i) points.col(i) = x.col(component.points[i]);
  const auto left_of = [&](double fraction_that_may_be_left) {
    StretchEnergy energy(component, {.max_stretch = 0.0});
    StretchSystem system;
    PcgSolver used(component);
    Points step;
    energy.set_load(1.0);
    energy.linearise(points, points, NearLimit::slack, system);
    used.solve(system, step);
    energy.set_load(16.0);
    energy.linearise(points, points, NearLimit::slack, system);
    const Scalars now = system.residual.reshaped();
    const double gain = 0.5 * now.dot(dense(component, system).ldlt().solve(now));
    system.is_like_last = true;
    system.may_be_left = fraction_that_may_be_left * gain;
    return used.solve(system, step) / gain;
  };
  EXPECT_GE(left_of(16.0), 1.0);
  EXPECT_LE(left_of(0.0), 0.16);
}

// Two springs of 1 m, each pinned at one end.
TEST(StretchNewton, ReportsTheLargestDeformationOfAComponent) {
  NetworkBuilder builder;
  for (const double z : {0.0, 1.0}) {
    const Index pinned = builder.add_particle({0.0, 0.0, z}, 1.0);
    builder.add_spring(pinned, builder.add_particle({1.0, 0.0, z}, 1.0), 0.0, 1.0);
    builder.pin(pinned);
  }
  const SpringNetwork springs = builder.build();
  for (const Index end : {1, 3}) {
    StretchNewton newton(springs, {});
    Points target = springs.positions;
    target(1, end) += 0.1;
    newton.solve(springs.positions, target, 1.0e-3);
    EXPECT_EQ(newton.deformation(), 0.1) << end;
  }
}

// Without any load, not even gravity, links that are too long at first reach their limit.
TEST(StretchNewton, EnforcesTheLimitWithoutGravity) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0, false);
  const Points before = 1.2 * network.positions;
  Points x = before;
  const StretchLimitSettings settings{.max_stretch = 0.0, .solver = StretchLimitSettings::Solver::newton};
  ASSERT_GT(StretchNewton(network, settings).solve(before, x, 0.0), 0);
  EXPECT_LT(StretchLimit(network, settings).excess(x), 0.02);
}

TEST(StretchNewton, LeavesSlackSpringsAtTheTarget) {
  const SpringNetwork network = make_test_rope(20, 0.0);
  Points x = 0.5 * network.positions;
  const Points target = x;
  EXPECT_FALSE(StretchNewton(network, {}).solve(network.positions, x, 1.0e-3));
  EXPECT_EQ(x, target);
}

// Internal forces cancel, so sum m x stays that of the target in all iterations, up to the rounding of each particle's position in
// each of at most 20 iterations.
TEST(StretchNewton, ConservesTheMomentumOfAFreeNetwork) {
  for (const SpringNetwork& network :
       {make_test_cloth(8, 0.0, 0.0, false), make_random_network(60, 59), make_random_network(60, 200)}) {
    std::mt19937 random(8);
    Points target = network.positions;
    target.reshaped() += random_displacement(random, static_cast<Index>(target.size()), 0.2);
    Points x = target;
    StretchNewton(network, {.max_stretch = 0.0, .solver = StretchLimitSettings::Solver::newton})
        .solve(network.positions, x, 1.0e-3);
    EXPECT_GT((x - target).norm(), 1.0e-3);
    // The equations' rounding is that of their stiffest link, k / m = 1 / (give d) > 1e4 times coarser than the positions'.
    EXPECT_LT(((x - target) * network.masses).norm(), 1.0e-9 * network.masses.sum());
  }
}

TEST(StretchNewton, EnforcesTheLimitOfAHangingRope) {
  for (const Index particles : {2, 10, 100, 1000}) {
    SpringNetwork network = make_test_rope(particles, 0.0);
    network.positions.row(1) = -network.positions.row(0);
    network.positions.row(0).setZero();
    const StretchLimitSettings settings{.max_stretch = 0.001, .solver = StretchLimitSettings::Solver::newton};
    const StretchLimit limit(network, settings);
    const double dt = 1.0 / 60.0;
    Points x = target_of_gravity(network, network.positions, Points::Zero(3, particles), dt);
    EXPECT_GT(limit.excess(x), 0.0);
    limit.solve(network.positions, x, kGravity * dt * dt);
    EXPECT_LE(limit.excess(x), settings.tolerance) << particles;
  }
}

TEST(StretchLimit, AutomaticSolvesForChainsAndLeavesClothsToPassesAtFirst) {
  using Solver = StretchLimitSettings::Solver;
  const auto chosen = [](const SpringNetwork& network, Solver solver, const LimitUse& use = {}) {
    return StretchLimit(network, {.solver = solver}, use).chosen_solver();
  };
  const SpringNetwork rope = make_test_rope(10, 0.0);
  const SpringNetwork cloth = make_test_cloth(5, 0.0, 0.0);
  EXPECT_EQ(chosen(rope, Solver::automatic), "newton");
  EXPECT_EQ(chosen(cloth, Solver::automatic), "gauss_seidel, then newton for what keeps missing the limit");
  EXPECT_EQ(chosen(cloth, Solver::automatic, {.may_collide = false}), "newton");
  const SpringNetwork springy = make_test_cloth(5, 100.0, 0.0);
  EXPECT_EQ(chosen(springy, Solver::automatic, {.may_collide = false}), chosen(cloth, Solver::automatic));
  EXPECT_EQ(chosen(springy, Solver::automatic, {.may_collide = false, .takes_small_steps = false}), "newton");
  EXPECT_EQ(chosen(cloth, Solver::newton), "newton");
  EXPECT_EQ(chosen(rope, Solver::gauss_seidel), "gauss_seidel");
  const StretchLimitSettings settings{.solver = Solver::automatic};
  EXPECT_EQ(StretchLimit(rope, settings).suggested_step(kGravity), std::numeric_limits<double>::infinity());
  EXPECT_EQ(StretchLimit(cloth, settings).suggested_step(kGravity), StretchLimit(cloth, {}).suggested_step(kGravity));
  Points x = 1.5 * cloth.positions;
  EXPECT_FALSE(StretchLimit(cloth, settings).solve(cloth.positions, x, 1.0e-3));
}

TEST(StretchLimit, FollowsTheTurnWhereGlobalSolvesEnforceAllSprings) {
  using Solver = StretchLimitSettings::Solver;
  const SpringNetwork cloth = make_test_cloth(4, 0.0, 0.0);
  const SpringNetwork rope = make_test_rope(4, 0.0);
  EXPECT_TRUE(StretchLimit(cloth, {.solver = Solver::newton}).follows_deformation());
  EXPECT_TRUE(StretchLimit(rope, {.solver = Solver::automatic}).follows_deformation());
  EXPECT_FALSE(StretchLimit(cloth, {.solver = Solver::gauss_seidel}).follows_deformation());
  EXPECT_FALSE(StretchLimit(cloth, {.solver = Solver::automatic}).follows_deformation());
  EXPECT_TRUE(StretchLimit(cloth, {.solver = Solver::automatic}).follows_deformation({{.solved_since = 0}}))
      << "left to global solves";
  EXPECT_TRUE(StretchLimit(cloth, {.solver = Solver::automatic}).may_follow_deformation());
  EXPECT_FALSE(StretchLimit(cloth, {.solver = Solver::newton}).may_follow_deformation()) << "it follows the turn already";
  EXPECT_FALSE(StretchLimit(cloth, {.solver = Solver::gauss_seidel}).may_follow_deformation());
  EXPECT_FALSE(StretchLimit(cloth, {.max_compression = 0.5, .solver = Solver::newton}).follows_deformation()) << "left to passes";
  EXPECT_FALSE(StretchLimit(rope, {.kinds = {SpringKind::shear}, .solver = Solver::newton}).follows_deformation())
      << "limits nothing";
}

// A rope between two pins farther apart than its length: the unavoidable excess is distributed evenly and reported.
TEST(StretchNewton, StretchesAnOverconstrainedRopeEvenly) {
  SpringNetwork network = make_test_rope(101, 0.0);
  network.inverse_masses[100] = 0.0;
  const StretchLimitSettings settings{.max_stretch = 0.0, .solver = StretchLimitSettings::Solver::newton};
  const StretchLimit limit(network, settings);
  Points x = network.positions;
  x(0, 100) = 1.5;
  limit.solve(network.positions, x, 1.0e-3);
  // Particles resist a displacement as if under gravity, all of which links carry within a quarter of the tolerance.
  EXPECT_NEAR(limit.excess(x), 0.5, 0.01);
  EXPECT_TRUE(x.allFinite());
}

TEST(StretchNewton, AcceptsSpringsWithoutLength) {
  SpringNetwork network = make_test_rope(3, 0.0);
  Points x = network.positions;
  x.col(2) = x.col(1);
  x(1, 1) = x(1, 2) = -1.0;
  StretchNewton(network, {}).solve(network.positions, x, 1.0e-3);
  EXPECT_TRUE(x.allFinite());
}

TEST(StretchNewton, FollowsPinsThatMove) {
  const SpringNetwork network = make_test_rope(50, 0.0);
  const StretchLimitSettings settings{.solver = StretchLimitSettings::Solver::newton};
  const StretchLimit limit(network, settings);
  Points x = network.positions;
  const Vector3 pin(-0.3, 0.2, 0.0);
  x.col(0) = pin;
  limit.solve(network.positions, x, 1.0e-3);
  EXPECT_EQ(x.col(0), pin);
  EXPECT_LE(limit.excess(x), settings.tolerance);
}

/// Three networks side by side that swing for some steps.
Points swing(double scale, int threads) {
  const ThreadLimit at_most(threads);
  SpringNetwork network = make_random_network(300, 450, true);
  network.positions *= scale;
  network.velocities *= scale;
  for (double& rest_length : network.springs.rest_length) rest_length *= scale;
  StretchNewton newton(network, {});
  const double dt = 0.01;
  Points before = network.positions;
  Points velocities = network.velocities;
  for (int step = 0; step < 3; ++step) {
    Points x = before;
    for (Index i = 0; i < network.particle_count(); ++i) {
      if (!network.is_fixed(i)) x.col(i) += dt * velocities.col(i) - scale * kGravity * dt * dt * Vector3::UnitY();
    }
    newton.solve(before, x, scale * kGravity * dt * dt);
    velocities = (x - before) / dt;
    before = x;
  }
  return before;
}

TEST(StretchNewton, HasTheSameBitsForAnyNumberOfThreadsAndAnyScale) {
  const Points expected = swing(1.0, 1);
  EXPECT_EQ(swing(1.0, 2), expected);
  EXPECT_EQ(Points(swing(128.0, 1) / 128.0), expected);
  EXPECT_EQ(Points(swing(1.0 / 128.0, 1) * 128.0), expected);
}

// A cloth that falls from level about two of its corners: in each step its links are within the tolerance, with about one factor.
TEST(StretchNewton, EnforcesTheLimitOfASwingingCloth) {
  const SpringNetwork network = make_test_cloth(20, 0.0, 0.0);
  const StretchLimitSettings settings{.max_stretch = 0.0, .tolerance = 0.01, .solver = StretchLimitSettings::Solver::newton};
  const StretchLimit limit(network, settings);
  const double dt = 1.0 / 240.0;
  Points x = network.positions;
  x.row(2) = -network.positions.row(1);
  x.row(1).setZero();
  Points velocities = Points::Zero(3, x.cols());
  int solves = 0;
  double lowest = 0.0;
  constexpr int kSteps = 180;
  for (int step = 0; step < kSteps; ++step) {
    const Points before = x;
    x = target_of_gravity(network, before, velocities, dt);
    solves += limit.solve(before, x, kGravity * dt * dt).value_or(0);
    velocities = (x - before) / dt;
    ASSERT_LE(limit.excess(x), settings.tolerance) << step;
    lowest = std::min(lowest, x.row(1).minCoeff());
  }
  EXPECT_LT(lowest, -0.9);
  EXPECT_LT(solves, 1.5 * kSteps);
}

// A stiff rod: period 2 pi sqrt(l / g) times 1 + a^2 / 16 for an amplitude a. The limit pulls along the rod's direction at the end
// of a step, which differs from its mean direction by the angle w dt. So it removes the fraction 2 dt f / (m l) of the kinetic
// energy per second: w0^2 dt of the energy, up to terms of the order of a^2.
TEST(StretchNewton, PendulumKeepsItsPeriodAndItsEnergy) {
  constexpr double kLength = 0.5;
  constexpr double kAmplitude = 0.3;
  constexpr double kStep = 1.0e-3;
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_particle(kLength * Vector3(std::sin(kAmplitude), -std::cos(kAmplitude), 0.0), 1.0);
  builder.add_spring(0, 1, 0.0, kLength);
  builder.pin(0);
  const SpringNetwork network = builder.build();
  StretchNewton newton(network, {.max_stretch = 0.0});
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -kGravity, 0.0)));
  const auto integrator = make_integrator(VerletSettings{}, network);
  SimulationState state = initial_state(network);
  integrator->start(state, forces, kStep);
  std::vector<double> crossings;
  while (crossings.size() < 9 && state.step < 10000) {
    const Points before = state.x;
    integrator->advance(state, forces, kStep);
    const Points advanced = state.x;
    newton.solve(before, state.x, kGravity * kStep * kStep);
    integrator->recover_velocities(state, forces, before, advanced, kStep);
    if ((before(0, 1) > 0.0) != (state.x(0, 1) > 0.0)) {
      crossings.push_back((static_cast<double>(state.step) + before(0, 1) / (before(0, 1) - state.x(0, 1))) * kStep);
    }
    ++state.step;
  }
  ASSERT_EQ(crossings.size(), 9u);
  const double period = (crossings.back() - crossings.front()) / 4.0;
  const double expected = 2.0 * std::numbers::pi * std::sqrt(kLength / kGravity) * (1.0 + kAmplitude * kAmplitude / 16.0);
  // The amplitude decreases by 6 % during the four measured periods, and the term of the period that depends on it by twice that.
  EXPECT_NEAR(period, expected, 0.2 * kAmplitude * kAmplitude / 16.0 * expected);
  const double energy = 0.5 * state.v.col(1).squaredNorm() + kGravity * (state.x(1, 1) + kLength);
  const double at_start = kGravity * kLength * (1.0 - std::cos(kAmplitude));
  const double lost = kGravity / kLength * kStep * crossings.back();
  EXPECT_NEAR(std::log(at_start / energy), lost, (kAmplitude * kAmplitude + 0.03) * lost);
}

}  // namespace
}  // namespace sprung
