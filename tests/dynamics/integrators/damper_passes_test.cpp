#include "dynamics/integrators/damper_passes.h"

#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/integrators/stable_step.h"
#include "dynamics/network_bounds.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace sprung {
namespace {

const std::vector<IntegratorSettings> kSplitting{SymplecticEulerSettings{}, VerletSettings{}, VelocityVerletSettings{},
                                                 RungeKutta4Settings{}};

SpringNetwork of_material(SpringNetwork network) {
  for (Body& body : network.bodies) body.has_material_dampers = {true, true, true};
  return network;
}

/// Springs and angle bends between random particles, all damped.
SpringNetwork make_network(bool pin_one) {
  constexpr Index kParticles = 30;
  SpringNetwork network = make_random_network(kParticles, 80, pin_one);
  for (Index i = 0; i + 2 < kParticles; i += 3) {
    const auto bond = [&](Index a) { return (network.positions.col(a + 1) - network.positions.col(a)).norm(); };
    network.angle_bends.append({i, i + 1, i + 2}, {bond(i), bond(i + 1)}, 0.5, 0.05);
  }
  network.bodies[0].angle_bend_count = network.angle_bends.count();
  return of_material(std::move(network));
}

/// A network that the scheme advances with the dampers apart, in steps of `dt` [s].
class DampedRun {
 public:
  DampedRun(const SpringNetwork& network, const IntegratorSettings& settings, double dt)
      : network_(network), dt_(dt), integrator_(make_integrator(settings, network)), state(initial_state(network)) {
    forces_.push_back(std::make_unique<SpringForce>(network, springs_without_material_dampers(network)));
    forces_.push_back(std::make_unique<BendingAngleForce>(network, bends_without_material_dampers(network)));
    const double most = most_damping_rate(dt);
    integrator_->set_dampers(material_dampers(network, most), std::min(most, spectral_bounds(network).material_damping));
  }

  void start() { integrator_->start(state, forces_, dt_); }

  void advance(int steps) {
    for (int k = 0; k < steps; ++k) {
      integrator_->advance(state, forces_, dt_);
      ++state.step;
    }
  }

  [[nodiscard]] double energy() const {
    return 0.5 * network_.masses.dot(state.v.colwise().squaredNorm().transpose()) +
           energy_of(forces_, EnergyKind::elastic, state.x);
  }

 private:
  const SpringNetwork& network_;
  double dt_;
  std::unique_ptr<Integrator> integrator_;
  Forces forces_;

 public:
  SimulationState state;
};

Vector3 momentum(const SpringNetwork& network, const Points& v) { return v * network.masses; }

Vector3 spin(const SpringNetwork& network, const Points& x, const Points& v) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < network.particle_count(); ++i) sum += network.masses[i] * Vector3(x.col(i)).cross(Vector3(v.col(i)));
  return sum;
}

double kinetic(const SpringNetwork& network, const Points& v) {
  return 0.5 * network.masses.dot(v.colwise().squaredNorm().transpose());
}

// For fast modes, P lies between (10.8 - 1) / 15.8 and (10.8 + 1) / 15.8, the extremes of a Chebyshev polynomial between its roots.
// The polynomial falls to the upper one at the rate at which its argument is 1, at most 0.3 / dt: exp(-0.3) is 0.74.
TEST(DamperSeries, NeverTurnsAMotionRoundAndDampsWhatIsFast) {
  constexpr double kStep = 0.1;
  for (double rate = 1.0; rate <= most_damping_rate(kStep); rate *= 1.3) {
    const DamperSeries series = damper_series(kStep, rate);
    EXPECT_LE(series.passes.size(), kMostDamperPasses);
    for (int k = 0; k <= 1000; ++k) {
      const double of_mode = rate * k / 1000.0;
      EXPECT_GE(series.factor(of_mode), 9.8 / 15.8 - 1e-9) << rate << " " << of_mode;
      EXPECT_LE(series.factor(of_mode), of_mode * kStep > 0.5 ? 11.8 / 15.8 + 1e-9 : 1.0 + 1e-12) << rate << " " << of_mode;
    }
  }
}

// exp(-rate dt) to the first order: the second derivative of P is at most 6 dt^2, so that a mode of the rate 0.01 / dt differs by
// 3e-4 at most.
TEST(DamperSeries, DampsSlowModesByTheirRate) {
  for (const double fastest : {0.3, 3.0, 30.0, 60.0}) {
    EXPECT_NEAR(damper_series(1.0, fastest).factor(0.01), std::exp(-0.01), 3e-4) << fastest;
    EXPECT_NEAR(damper_series(1.0, fastest).factor(0.0), 1.0, 1e-12) << fastest;
  }
}

// What s passes bear is (w0 + 1) T_s'(w0) / 15.8 with T_s(w0) = 5: 0.38, 1.2, 2.55, 4.45.
TEST(DamperSeries, HasAsFewPassesAsTheRootOfTheRateNeeds) {
  EXPECT_EQ(damper_series(1.0, 0.37).passes.size(), 1);
  EXPECT_EQ(damper_series(1.0, 1.1).passes.size(), 2);
  EXPECT_EQ(damper_series(1.0, 2.5).passes.size(), 3);
  EXPECT_EQ(damper_series(1.0, 4.4).passes.size(), 4);
  EXPECT_EQ(damper_series(1.0, 1e9).passes.size(), kMostDamperPasses);
}

TEST(DamperPasses, KeepMomentumAndSpinAndTakeEnergy) {
  const SpringNetwork network = make_network(false);
  DamperPasses passes(network);
  const double most = most_damping_rate(1.0);
  passes.set(material_dampers(network, most), std::min(most, spectral_bounds(network).material_damping));
  SimulationState state = initial_state(network);
  passes.apply(state.x, 1.0, state);
  const double size = network.masses.sum() * network.velocities.norm();
  EXPECT_LE((momentum(network, state.v) - momentum(network, network.velocities)).norm(), 1e-11 * size);
  EXPECT_LE((spin(network, state.x, state.v) - spin(network, state.x, network.velocities)).norm(), 1e-11 * size);
  EXPECT_LT(kinetic(network, state.v), 0.95 * kinetic(network, network.velocities));
}

// A rigid motion changes no length and no angle, so that no damper acts.
TEST(DamperPasses, LeaveRigidMotionAlone) {
  SpringNetwork network = make_network(false);
  const Vector3 turn(3.0, -1.0, 2.0);
  for (Index i = 0; i < network.particle_count(); ++i) {
    network.velocities.col(i) = Vector3(5.0, -20.0, 7.0) + turn.cross(Vector3(network.positions.col(i)));
  }
  DamperPasses passes(network);
  passes.set(material_dampers(network, most_damping_rate(1.0)), most_damping_rate(1.0));
  SimulationState state = initial_state(network);
  passes.apply(state.x, 1.0, state);
  EXPECT_LE((state.v - network.velocities).norm(), 1e-10 * network.velocities.norm());
}

TEST(DamperPasses, GiveThePinWhatTheOthersLose) {
  const SpringNetwork network = make_network(true);
  DamperPasses passes(network);
  passes.set(material_dampers(network, most_damping_rate(0.1)), most_damping_rate(0.1));
  SimulationState state = initial_state(network);
  state.impulses = {.on_pinned = Points::Zero(3, network.particle_count()), .of_springs = Scalars::Zero(network.springs.count())};
  passes.apply(state.x, 0.1, state);
  const Vector3 lost = momentum(network, network.velocities) - momentum(network, state.v);
  EXPECT_GT(lost.norm(), 0.01);
  EXPECT_LE((state.impulses.on_pinned.col(0) - lost).norm(), 1e-11);
}

// Two masses of 1 kg and a damper c: the relative velocity decays as exp(-2 c t). Each scheme has first order in what the passes
// do, so half the step halves the error.
TEST(DamperPasses, ConvergeToTheDecayOfADamper) {
  constexpr double kDamping = 3.0;
  SpringNetwork network = of_material(make_pair(1.0, 0.0, 1.0, kDamping));
  network.velocities.col(1) = Vector3(0.1, 0.0, 0.0);
  const double exact = 0.1 * std::exp(-2.0 * kDamping * 0.5);
  for (const IntegratorSettings& settings : kSplitting) {
    const auto error = [&](int steps) {
      DampedRun run(network, settings, 0.5 / steps);
      run.start();
      run.advance(steps);
      return (run.state.v(0, 1) - run.state.v(0, 0)) - exact;
    };
    EXPECT_NEAR(error(200) / error(400), 2.0, 0.1) << settings.index();
    // One pass is a step of explicit Euler. It misses 1/2 (rate dt)^2 a step: 400 times 1/2 (6 * 0.5 / 400)^2 = 0.0113.
    EXPECT_LE(std::abs(error(400)), 0.0115 * exact) << settings.index();
  }
}

// What rests against a constraint has no velocity at the begin of a step. Its forces then act in full: dampers that weakened them
// would shift the equilibrium. Many dampers at a high rate.
TEST(DamperPasses, LeaveWhatForcesGiveFromRest) {
  SpringNetwork damped = make_network(true);
  damped.velocities.setZero();
  for (double& damping : damped.springs.damping) damping = 50.0;
  for (double& rest : damped.springs.rest_length) rest *= 0.5;
  SpringNetwork plain = damped;
  std::ranges::fill(plain.springs.damping, 0.0);
  std::ranges::fill(plain.angle_bends.damping, 0.0);
  for (const IntegratorSettings& settings : kSplitting) {
    const double dt = 0.1 * largest_stable_step(settings, spectral_bounds(plain));
    DampedRun with(damped, settings, dt);
    DampedRun without(plain, settings, dt);
    for (DampedRun* run : {&with, &without}) {
      run->start();
      run->advance(1);
    }
    EXPECT_LE((with.state.x - without.state.x).norm(), 1e-15 * without.state.x.norm()) << settings.index();
    EXPECT_GT(without.state.v.norm(), 0.0);
    EXPECT_LE((with.state.v - without.state.v).norm(), 1e-12 * without.state.v.norm()) << settings.index();
  }
}

// Springs and dampers whose modes differ, so that no mode of the one is one of the other.
TEST(DamperPasses, NeedNoSmallerStepThanTheSpringsAlone) {
  SpringNetwork network = make_network(true);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-1.0, 3.0);
  for (double& damping : network.springs.damping) damping = std::pow(10.0, exponent(random));
  for (Index s = 0; s < network.springs.count(); ++s) {
    network.springs.rest_length[s] =
        0.5 * (network.positions.col(network.springs.first[s]) - network.positions.col(network.springs.second[s])).norm();
  }
  const SpectralBounds bounds = spectral_bounds(network);
  for (const IntegratorSettings& settings : kSplitting) {
    const double dt = 0.9 * largest_stable_step(settings, bounds);
    EXPECT_GT(dt, 20.0 * largest_stable_step(settings, with_all_dampers(bounds)));
    DampedRun run(network, settings, dt);
    run.start();
    const double before = run.energy();
    run.advance(2000);
    EXPECT_LT(run.energy(), before) << settings.index();
  }
}

TEST(MaterialDampers, AreWeakerOnlyWhereTheyExceedTheRate) {
  // A rope of equal dampers, but the first one is a million times stronger.
  SpringNetwork network = of_material(make_test_rope(20, 50.0));
  std::ranges::fill(network.springs.damping, 1e-3);
  network.springs.damping[0] = 1e3;
  const double calm = 4.0 * 1e-3 / network.masses[1];  // the row sum of a particle between two equal dampers
  const Forces dampers = material_dampers(network, 10.0 * calm);
  std::vector<LinearElement> elements;
  for (const auto& force : dampers) force->append_elements(elements);
  ASSERT_EQ(elements.size(), network.springs.damping.size());
  EXPECT_LE(spectral_bounds(elements, network.inverse_masses).material_damping, 1.016 * 10.0 * calm);
  EXPECT_LT(elements[0].damping, 0.1);
  for (std::size_t s = 2; s < elements.size(); ++s) EXPECT_EQ(elements[s].damping, 1e-3) << s;
}

TEST(MaterialDampers, LeaveThoseOfTheSceneWithTheSprings) {
  SpringNetwork network = make_test_cloth(4, 100.0, 0.3);
  network.bodies[0].has_material_dampers = {true, false, false};
  const ElementConstants left = springs_without_material_dampers(network);
  for (Index s = 0; s < network.springs.count(); ++s) {
    EXPECT_EQ(left.damping[s], network.springs.kind[s] == SpringKind::structural ? 0.0 : network.springs.damping[s]);
    EXPECT_EQ(left.stiffness[s], network.springs.stiffness[s]);
  }
  const SpectralBounds bounds = spectral_bounds(network);
  EXPECT_GT(bounds.all_damping, bounds.damping);
  EXPECT_GT(bounds.all_damping, bounds.material_damping);
}

// The gradient of an angle grows as bonds become shorter: without a bound, so does the rate of the damper.
TEST(MaterialDampers, OfCompressedBendsDampNoFasterThanAtRest) {
  NetworkBuilder builder;
  for (const Vector3& position : {Vector3(0.0, 0.0, 0.0), Vector3(1.0, 0.0, 0.0), Vector3(2.0, 0.0, 0.0)})
    builder.add_particle(position, 1.0);
  builder.add_angle_bend(0, 1, 2, 1.0, 1.0);
  const SpringNetwork network = of_material(builder.build());
  const double rate = spectral_bounds(network).material_damping;
  const Forces dampers = material_dampers(network, 1e6);
  for (const double length : {0.2, 0.5, 0.8, 1.0, 1.5}) {
    Points x(3, 3);
    x << 0.0, length, 1.9 * length, 0.0, 0.0, 0.3 * length, 0.0, 0.0, 0.0;
    // The motion that the damper resists most is its own force.
    Points v = Points::Zero(3, 3);
    v(1, 2) = 1.0;
    for (const auto& damper : dampers) damper->hold(x);
    Points direction;
    sum_forces(dampers, {.x = x, .v = v, .time = 0.0}, direction);
    Points force;
    sum_forces(dampers, {.x = x, .v = direction, .time = 0.0}, force);
    EXPECT_LE(-force.cwiseProduct(direction).sum() / direction.squaredNorm(), rate) << length;
  }
}

}  // namespace
}  // namespace sprung
