#include "dynamics/integrators/stable_step.h"

#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/network_bounds.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"

#include <gmock/gmock.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <vector>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The largest eigenvalue of M^-1 L among free particles, from the dense matrix.
double dense_eigenvalue(const SpringNetwork& network, const std::vector<double>& weights) {
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(network.particle_count(), network.particle_count());
  for (Index k = 0; k < network.springs.count(); ++k) {
    const Index a = network.springs.first[k];
    const Index b = network.springs.second[k];
    laplacian(a, a) += weights[k];
    laplacian(b, b) += weights[k];
    laplacian(a, b) -= weights[k];
    laplacian(b, a) -= weights[k];
  }
  const Scalars root = network.inverse_masses.cwiseSqrt();
  laplacian = root.asDiagonal() * laplacian * root.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(laplacian, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

// The bound may be at most 1.5 % too large: a residual of 1 % and half a per cent, as its comment promises.
void expect_just_above(double bound, double eigenvalue) {
  EXPECT_GE(bound, eigenvalue);
  EXPECT_LE(bound, 1.016 * eigenvalue);
}

TEST(SpectralBounds, AreJustAboveTheEigenvalues) {
  for (const SpringNetwork& network :
       {make_random_network(40, 100), make_random_network(60, 90, true), make_random_network(10, 12, true),
        make_test_cloth(16, 400.0, 0.1), make_test_cloth(12, 400.0, 0.1, false), make_test_rope(100, 50.0)}) {
    const SpectralBounds bounds = spectral_bounds(network);
    expect_just_above(bounds.elastic, dense_eigenvalue(network, network.springs.stiffness));
    expect_just_above(bounds.damping, dense_eigenvalue(network, network.springs.damping));
  }
}

TEST(SpectralBounds, AreTheClosedFormOfOneSpring) {
  // Two free masses m: 2 k / m. One pinned: k / m.
  expect_just_above(spectral_bounds(make_pair(1.0, 8.0, 1.0, 2.0, false, 0.5)).elastic, 32.0);
  expect_just_above(spectral_bounds(make_pair(1.0, 8.0, 1.0, 2.0, true, 0.5)).elastic, 16.0);
  expect_just_above(spectral_bounds(make_pair(1.0, 8.0, 1.0, 2.0, true, 0.5)).damping, 4.0);
}

TEST(SpectralBounds, AreTheLimitOfALongRope) {
  // 4 k / m, which the zigzag of neighbours reaches.
  const SpringNetwork rope = make_test_rope(20000, 50.0);
  expect_just_above(spectral_bounds(rope).elastic, 4.0 * 50.0 / rope.masses[0]);
}

TEST(SpectralBounds, HaveTheSameBitsInEveryRun) {
  const SpringNetwork cloth = make_test_cloth(40, 400.0, 0.1);
  EXPECT_EQ(spectral_bounds(cloth).elastic, spectral_bounds(cloth).elastic);
}

TEST(SpectralBounds, AreZeroWithoutSprings) {
  const SpectralBounds bounds = spectral_bounds(make_random_network(3, 0), 0.0);
  EXPECT_EQ(bounds.elastic, 0.0);
  EXPECT_EQ(bounds.damping, 0.0);
  EXPECT_EQ(bounds.damping_time, 0.0);
  EXPECT_EQ(largest_stable_step(SymplecticEulerSettings{}, bounds), kInfinity);
  EXPECT_EQ(largest_stable_step(VerletSettings{.damping_rate = 1.0}, bounds), kInfinity);
  EXPECT_EQ(largest_stable_step(ExplicitEulerSettings{}, bounds), kInfinity);
  EXPECT_EQ(largest_stable_step(VelocityVerletSettings{}, bounds), kInfinity);
  EXPECT_EQ(largest_stable_step(RungeKutta4Settings{}, bounds), kInfinity);
  EXPECT_EQ(growth_time(ExplicitEulerSettings{}, bounds, 1.0), kInfinity);
}

TEST(SpectralBounds, IgnoreSpringsBetweenPins) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_particle(Vector3::UnitX(), 1.0);
  builder.add_spring(0, 1, 1.0e9, 1.0);
  builder.pin({0, 1});
  EXPECT_EQ(largest_stable_step(SymplecticEulerSettings{}, spectral_bounds(builder.build(), 1.0)), kInfinity);
}

TEST(StableStep, SolvesItsInequality) {
  const SpectralBounds bounds{.elastic = 900.0, .damping = 9.0};
  const auto left = [&](double dt) { return dt * dt * 900.0 + 2.0 * dt * 9.0; };
  EXPECT_NEAR(left(largest_stable_step(SymplecticEulerSettings{}, bounds)), 4.0, 1e-13);
  EXPECT_NEAR(left(largest_stable_step(VerletSettings{.damping = 0.25}, bounds)), 3.5, 1e-13);
  const double with_rate = largest_stable_step(VerletSettings{.damping_rate = 5.0}, bounds);
  EXPECT_NEAR(left(with_rate), 4.0 - 2.0 * (1.0 - std::exp(-5.0 * with_rate)), 1e-12);
}

/// The largest factor by which a step of velocity Verlet multiplies a combination of modes, whatever their shapes: `stiffness` and
/// `damping` are M^-1 K dt^2 and M^-1 C dt. Computed directly from a1 = -K x1 - C (v0 + a0).
double velocity_verlet_radius(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping) {
  const Eigen::Index n = stiffness.rows();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd x0(n, 2 * n);
  Eigen::MatrixXd v0(n, 2 * n);
  x0 << one, Eigen::MatrixXd::Zero(n, n);
  v0 << Eigen::MatrixXd::Zero(n, n), one;
  const Eigen::MatrixXd a0 = -stiffness * x0 - damping * v0;
  const Eigen::MatrixXd x1 = x0 + v0 + 0.5 * a0;
  const Eigen::MatrixXd a1 = -stiffness * x1 - damping * (v0 + a0);
  Eigen::MatrixXd step(2 * n, 2 * n);
  step << x1, v0 + 0.5 * (a0 + a1);
  return Eigen::EigenSolver<Eigen::MatrixXd>(step, false).eigenvalues().cwiseAbs().maxCoeff();
}

double velocity_verlet_radius(double stiffness, double damping) {
  return velocity_verlet_radius(Eigen::MatrixXd::Constant(1, 1, stiffness), Eigen::MatrixXd::Constant(1, 1, damping));
}

/// The larger |R(s dt)| of RK4 for the roots of s^2 + c s + k, with `stiffness` k dt^2 and `damping` c dt.
double runge_kutta_radius(double stiffness, double damping) {
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * damping * damping - stiffness));
  const auto size = [](std::complex<double> z) { return std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))); };
  return std::max(size(root - 0.5 * damping), size(-root - 0.5 * damping));
}

/// The largest radius over modes with any fraction of the bounds' stiffness and damping.
template <class Radius>
double largest_radius(const SpectralBounds& bounds, double dt, const Radius& radius) {
  constexpr int kParts = 40;
  double largest = 0.0;
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; j <= kParts; ++j) {
      largest = std::max(largest, radius(dt * dt * bounds.elastic * i / kParts, dt * bounds.damping * j / kParts));
    }
  }
  return largest;
}

/// From no damping to a hundred times the oscillation.
std::vector<SpectralBounds> bounds_of_all_dampings() {
  std::vector<SpectralBounds> all{{.elastic = 900.0}, {.damping = 30.0}};
  for (double damping = 0.3; damping < 3000.0; damping *= 1.1) all.push_back({.elastic = 900.0, .damping = damping});
  return all;
}

// Roundings of a factor near 1: a double root turns 1e-16 into 1e-8.
constexpr double kNoGrowth = 1.0 + 1.0e-7;

// One mass on a spring of omega = 10 1/s.
TEST(ResonantStep, GivesSixStepsAPeriodToLightlyDampedModes) {
  const double slack = 1.0 / std::sqrt(1.016);
  const auto step = [](const SpringNetwork& network, const IntegratorSettings& settings, double drag = 0.0) {
    return resonant_step(settings, spectral_bounds(network, drag));
  };
  const SpringNetwork undamped = make_pair(1.0, 100.0, 1.0, 0.0, true);
  for (const IntegratorSettings& settings :
       {IntegratorSettings(SymplecticEulerSettings{}), IntegratorSettings(VerletSettings{}),
        IntegratorSettings(VelocityVerletSettings{}), IntegratorSettings(VerletSettings{.damping = 0.01})}) {
    EXPECT_LE(step(undamped, settings), 0.1);
    EXPECT_GE(step(undamped, settings), 0.1 * slack);
  }
  for (const IntegratorSettings& settings :
       {IntegratorSettings(ExplicitEulerSettings{}), IntegratorSettings(RungeKutta4Settings{}),
        IntegratorSettings(ImplicitEulerSettings{}), IntegratorSettings(VerletSettings{.damping = 0.03}),
        IntegratorSettings(VerletSettings{.damping_rate = 0.3})}) {
    EXPECT_EQ(step(undamped, settings), kInfinity) << settings.index();
  }
  EXPECT_EQ(step(make_pair(1.0, 100.0, 1.0, 0.3, true), SymplecticEulerSettings{}), kInfinity) << "damps by 1.5 %";
  EXPECT_LT(step(make_pair(1.0, 100.0, 1.0, 0.1, true), SymplecticEulerSettings{}), kInfinity) << "damps by 0.5 %";
}

TEST(ResonantStep, IsThatOfUndampedSpringsAlone) {
  NetworkBuilder builder;
  for (const double x : {-1.0, 0.0, 1.0}) builder.add_particle({x, 0.0, 0.0}, 1.0);
  builder.add_spring(0, 1, 100.0, 1.0, 0.3);
  builder.add_spring(1, 2, 4.0, 1.0);
  builder.pin({0, 2});
  EXPECT_NEAR(resonant_step(SymplecticEulerSettings{}, spectral_bounds(builder.build())), 0.5, 0.5 * 0.008);
}

TEST(StableStep, OfImplicitEulerIsAny) {
  for (const SpectralBounds& bounds : bounds_of_all_dampings()) {
    EXPECT_EQ(largest_stable_step(ImplicitEulerSettings{}, bounds), kInfinity);
  }
}

// Modes of half the stiffness and more may be damped by dt c = 1 exactly, which the grid misses by 1 / 80.
TEST(StableStep, OfVelocityVerletHoldsForAllDampedModesAndIsNoSmallerThanNeeded) {
  for (const SpectralBounds& bounds : bounds_of_all_dampings()) {
    const double dt = largest_stable_step(VelocityVerletSettings{}, bounds);
    const auto radius = [](double k, double c) { return velocity_verlet_radius(k, c); };
    EXPECT_LE(largest_radius(bounds, dt, radius), kNoGrowth) << bounds.damping;
    EXPECT_GT(largest_radius(bounds, 1.01 * dt, radius), 1.0 + 1.0e-3) << bounds.damping;
  }
}

// Between light and heavy damping the bound is discontinuous: it may be too small by 2.828 / 2.615 = 1.09.
TEST(StableStep, OfRungeKuttaHoldsForAllDampedModesAndIsNotMuchSmallerThanNeeded) {
  for (const SpectralBounds& bounds : bounds_of_all_dampings()) {
    const double dt = largest_stable_step(RungeKutta4Settings{}, bounds);
    EXPECT_LE(largest_radius(bounds, dt, runge_kutta_radius), kNoGrowth) << bounds.damping;
    EXPECT_GT(largest_radius(bounds, 1.1 * dt, runge_kutta_radius), kNoGrowth) << bounds.damping;
  }
}

// Different springs are stiff and strongly damped, so that no shape is a mode of both.
TEST(StableStep, OfVelocityVerletHoldsWhereDampersAndSpringsPullDifferently) {
  std::mt19937 random(5);
  const auto random_matrix = [&](double largest, double sparsity) {
    Eigen::MatrixXd root(12, 12);
    for (double& entry : root.reshaped()) {
      const double uniform = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
      entry = uniform < sparsity ? 0.0 : uniform - 0.5;
    }
    const Eigen::MatrixXd square = root * root.transpose();
    return Eigen::MatrixXd(largest / Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(square).eigenvalues().maxCoeff() * square);
  };
  for (int trial = 0; trial < 200; ++trial) {
    const SpectralBounds bounds{.elastic = 900.0, .damping = 0.3 * std::pow(1.05, trial)};
    const double dt = largest_stable_step(VelocityVerletSettings{}, bounds);
    const Eigen::MatrixXd stiffness = random_matrix(dt * dt * bounds.elastic, 0.1 * (trial % 10));
    const Eigen::MatrixXd damping = random_matrix(dt * bounds.damping, 0.1 * (trial / 10 % 10));
    EXPECT_LE(velocity_verlet_radius(stiffness, damping), kNoGrowth) << trial;
  }
}

/// The largest coordinate after this number of steps from the disturbed initial state.
double size_after(const SpringNetwork& network, const IntegratorSettings& settings, double drag, double dt, int steps) {
  Forces forces;
  forces.push_back(std::make_unique<SpringForce>(network));
  forces.push_back(std::make_unique<AirDrag>(network, drag, Vector3::Zero()));
  SimulationState state = initial_state(network);
  const auto integrator = make_integrator(settings, network);
  integrator->start(state, forces, dt);
  for (; state.step < steps; ++state.step) {
    integrator->advance(state, forces, dt);
    if (!state.x.allFinite() || state.x.cwiseAbs().maxCoeff() > 1.0e6) return kInfinity;
  }
  return state.x.cwiseAbs().maxCoeff();
}

/// A cloth whose springs have rest length 0 is linear: its modes are the Laplacian's, in each direction. If it is stretched along
/// x it is damped along x. It starts with a small amount of every mode.
SpringNetwork linear_cloth(double damping) {
  SpringNetwork network = make_test_cloth(12, 400.0, damping);
  for (double& rest_length : network.springs.rest_length) rest_length = 0.0;
  network.positions.setZero();
  std::mt19937 random(3);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_fixed(i)) network.positions(0, i) = 1.0e-3 * (static_cast<double>(random() % 2001) / 1000.0 - 1.0);
  }
  return network;
}

// The bound is at most 1.6 % too small in its eigenvalue, so 1.2 times the step exceeds the true one. The fastest mode then grows
// by more than 1.2 a step, and 1e-3 m exceeds 1e6 m after some 100 steps. The dampings are none, light and far beyond critical.
TEST(StableStep, SeparatesStableFromDivergingRuns) {
  for (const double damping : {0.0, 0.05, 5.0}) {
    for (const double drag : {0.0, 1.0}) {
      for (const IntegratorSettings& settings :
           {IntegratorSettings{SymplecticEulerSettings{}}, IntegratorSettings{VerletSettings{}},
            IntegratorSettings{VerletSettings{.damping = 0.05}}, IntegratorSettings{VerletSettings{.damping_rate = 10.0}},
            IntegratorSettings{VelocityVerletSettings{}}, IntegratorSettings{RungeKutta4Settings{}}}) {
        const SpringNetwork network = linear_cloth(damping);
        const double largest = largest_stable_step(settings, spectral_bounds(network, drag));
        EXPECT_LT(size_after(network, settings, drag, 0.999 * largest, 2000), 1.0) << damping << ' ' << drag;
        EXPECT_EQ(size_after(network, settings, drag, 1.2 * largest, 2000), kInfinity) << damping << ' ' << drag;
      }
    }
  }
}

TEST(StableStep, HoldsForAClothThatHangsAndSwings) {
  const SpringNetwork network = make_test_cloth(12, 400.0, 0.02);
  for (const IntegratorSettings& settings :
       {IntegratorSettings{SymplecticEulerSettings{}}, IntegratorSettings{VerletSettings{}},
        IntegratorSettings{VelocityVerletSettings{}}, IntegratorSettings{RungeKutta4Settings{}}}) {
    Forces forces;
    forces.push_back(std::make_unique<SpringForce>(network));
    forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, 0.0, -9.81)));
    const double dt = 0.999 * largest_stable_step(settings, spectral_bounds(network));
    SimulationState state = initial_state(network);
    const auto integrator = make_integrator(settings, network);
    integrator->start(state, forces, dt);
    for (; state.step < 5000; ++state.step) integrator->advance(state, forces, dt);
    EXPECT_LT(state.x.cwiseAbs().maxCoeff(), 2.0);
  }
}

TEST(GrowthTime, IsExplicitEulersOnly) {
  const SpectralBounds bounds{.elastic = 100.0};
  EXPECT_EQ(growth_time(SymplecticEulerSettings{}, bounds, 0.01), kInfinity);
  EXPECT_EQ(growth_time(VerletSettings{}, bounds, 0.01), kInfinity);
  EXPECT_EQ(growth_time(VelocityVerletSettings{}, bounds, 0.01), kInfinity);
  EXPECT_EQ(growth_time(RungeKutta4Settings{}, bounds, 0.01), kInfinity);
  EXPECT_EQ(growth_time(ImplicitEulerSettings{}, bounds, 0.01), kInfinity);
  EXPECT_DOUBLE_EQ(growth_time(ExplicitEulerSettings{}, bounds, 0.01), 2.0);
}

TEST(GrowthTime, IsTheMeasuredGrowthOfAnUndampedSpring) {
  // The amplitude grows by sqrt(1 + (omega dt)^2) a step, e in 2 / (omega^2 dt) to first order in (omega dt)^2 = 0.0016.
  const SpringNetwork network = make_pair(1.0, 16.0, 0.0, 0.0, true);
  const double dt = 0.01;
  const double time = growth_time(ExplicitEulerSettings{}, spectral_bounds(network), dt);
  const int steps = static_cast<int>(std::lround(time / dt));
  Forces forces;
  const SpringForce spring(network);
  SimulationState state = initial_state(network);
  forces.push_back(std::make_unique<SpringForce>(network));
  const auto integrator = make_integrator(ExplicitEulerSettings{}, network);
  const double start = spring.energy(state.x);
  for (; state.step < steps; ++state.step) integrator->advance(state, forces, dt);
  const double energy = spring.energy(state.x) + 0.5 * state.v.col(1).squaredNorm();
  EXPECT_NEAR(std::log(energy / start), 2.0, 0.05);  // the bound's margin of 1.5 %, and first order
}

// All modes along the springs are stable below k_d / k_s: |1 + s dt|^2 = 1 - c dt + omega^2 dt^2 < 1.
TEST(GrowthTime, EndsWhereDampingOutweighsTheGain) {
  const SpringNetwork network = linear_cloth(1.0);
  const SpectralBounds bounds = spectral_bounds(network);
  EXPECT_DOUBLE_EQ(bounds.damping_time, 1.0 / 400.0);
  EXPECT_EQ(growth_time(ExplicitEulerSettings{}, bounds, 0.99 / 400.0), kInfinity);
  EXPECT_LT(growth_time(ExplicitEulerSettings{}, bounds, 1.01 / 400.0), kInfinity);
}

/// A rope of 1 m whose angle bends are far stiffer than its springs.
SpringNetwork make_test_rod(Index particles, double damping = 0.0) {
  BodyShape shape = make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = particles, .length = {}},
                              {.structural = SpringMaterial{.value = 1.0},
                               .bend = SpringMaterial{.value = 4.0, .damping = damping},
                               .bend_model = SpringMaterials::BendModel::angle});
  set_total_mass(shape, 0.1 * particles);
  NetworkBuilder builder;
  builder.add_body("rod", shape);
  return builder.build();
}

TEST(SpectralBounds, OfALongRodAreThoseOfTheZigzag) {
  // Each element rotates by (1 + 2 + 1) / l, and each particle is in one with these weights: 16 k / (l^2 m). Springs add 4 k_s /
  // m.
  const SpringNetwork rod = make_test_rod(2000, 0.5);
  const double length = 1.0 / 1999.0;
  const SpectralBounds bounds = spectral_bounds(rod);
  expect_just_above(bounds.elastic, 16.0 * 4.0 / (length * length * 0.1) + 4.0 / 0.1);
  expect_just_above(bounds.damping, 16.0 * 0.5 / (length * length * 0.1));
  EXPECT_EQ(bounds.damping_time, 0.0) << "of its springs";
}

// A spring and an anchor on different particles do not add up; on one particle they do.
TEST(SpectralBounds, OfSeveralForcesAreThoseOfTheirSum) {
  const SpringNetwork pair = make_pair(1.0, 8.0, 1.0, 2.0, true, 0.5);  // particle 0 is pinned: k / m = 16
  const auto with_anchor = [&](Index particle) {
    std::vector<LinearElement> elements;
    SpringForce(pair).append_elements(elements);
    elements.push_back(LinearElement::anchor(particle, 5.0, 1.0));
    return spectral_bounds(elements, pair.inverse_masses);
  };
  expect_just_above(with_anchor(1).elastic, 26.0);
  expect_just_above(with_anchor(1).damping, 6.0);
  expect_just_above(with_anchor(0).elastic, 16.0);
}

// The quick bound is one of the same matrix.
TEST(SpectralBounds, AreBelowTheQuickOnes) {
  for (const SpringNetwork& network : {make_random_network(40, 100), make_test_cloth(16, 400.0, 0.1), make_test_rope(100, 50.0)}) {
    std::vector<LinearElement> elements;
    SpringForce(network).append_elements(elements);
    const SpectralBounds quick = quick_bounds(elements, network.inverse_masses);
    EXPECT_GE(quick.elastic, dense_eigenvalue(network, network.springs.stiffness));
    EXPECT_GE(quick.damping, dense_eigenvalue(network, network.springs.damping));
  }
}

/// The largest eigenvalue of M^-1 times the second derivative of the angle bends' energy, by differences of forces.
double bent_eigenvalue(const SpringNetwork& network, const Points& x) {
  const BendingAngleForce force(network);
  const Points v = Points::Zero(3, x.cols());
  Eigen::MatrixXd stiffness(x.size(), x.size());
  const double h = 1e-6 / static_cast<double>(x.cols());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Points there = x;
    Points back = x;
    there(i) += h;
    back(i) -= h;
    Points change = Points::Zero(3, x.cols());
    Points forces_back = Points::Zero(3, x.cols());
    force.add({.x = there, .v = v}, change);
    force.add({.x = back, .v = v}, forces_back);
    change -= forces_back;
    stiffness.col(i) = -change.reshaped() / (2.0 * h);
  }
  const Eigen::MatrixXd symmetric = 0.5 * (stiffness + stiffness.transpose()) * network.inverse_masses[0];
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

// An arc, a zigzag and a helix. Measured: from 0.99 of the straight rod's bound down to 0.4.
TEST(SpectralBounds, CoverBentShapes) {
  const SpringNetwork rod = make_test_rod(12);
  const double length = 1.0 / 11.0;
  const double bound = spectral_bounds(rod).elastic;
  for (const double degrees : {0.5, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0, 150.0, 170.0}) {
    for (const int shape : {0, 1, 2}) {
      Points x = Points::Zero(3, 12);
      Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
      for (Index i = 1; i < 12; ++i) {
        x.col(i) = x.col(i - 1) + length * frame.col(0);
        const double turn = (shape == 1 && i % 2 == 1 ? -1.0 : 1.0) * degrees;
        frame = frame * rotation_from_degrees({0, 0, turn}) * rotation_from_degrees({shape == 2 ? 70.0 : 0.0, 0, 0});
      }
      EXPECT_LE(bent_eigenvalue(rod, x), bound) << degrees << " degrees, shape " << shape;
    }
  }
}

// Just below the bound an amplitude keeps its size; just above it grows by some (1 + sqrt(8 * 0.02))^steps.
TEST(LargestStableStep, IsWhereARodWithAngleBendsDiverges) {
  const SpringNetwork rod = make_test_rod(60);
  const double largest = largest_stable_step(SymplecticEulerSettings{}, spectral_bounds(rod));
  const auto amplitude = [&](double step) {
    Forces forces;
    forces.push_back(std::make_unique<SpringForce>(rod));
    forces.push_back(std::make_unique<BendingAngleForce>(rod));
    SimulationState state = initial_state(rod);
    for (Index i = 0; i < 60; ++i) state.x(1, i) += (i % 2 == 0 ? 1e-7 : -1e-7) * (1.0 + 0.1 * std::sin(i));
    const auto integrator = make_integrator(SymplecticEulerSettings{}, rod);
    for (int step_number = 0; step_number < 400; ++step_number) integrator->advance(state, forces, step);
    return state.x.row(1).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(amplitude(0.99 * largest), 1e-5);
  EXPECT_GT(amplitude(1.03 * largest), 1e-3);
}

}  // namespace
}  // namespace sprung
