// A mass on a spring, whose motion has a closed form, for tests of the schemes.
#pragma once

#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"

#include <cmath>

namespace sprung {

/// A mass on a spring along x, whose other end is pinned at 0, under gravity along x: x'' = -k/m (x - d) - c/m x' + g.
struct Oscillator {
  double mass = 0.5;
  double stiffness = 8.0;
  double rest_length = 1.0;
  double damping = 0.0;
  double gravity = 0.0;
  double start = 1.2;
  double start_velocity = 0.3;

  [[nodiscard]] double acceleration(double x, double v) const {
    return (-stiffness * (x - rest_length) - damping * v) / mass + gravity;
  }
  [[nodiscard]] double energy(double x, double v) const {
    return 0.5 * mass * v * v + 0.5 * stiffness * (x - rest_length) * (x - rest_length);
  }
  [[nodiscard]] double omega() const { return std::sqrt(stiffness / mass); }

  /// Closed form, underdamped.
  [[nodiscard]] double exact(double t) const {
    const double middle = rest_length + gravity * mass / stiffness;
    const double decay = 0.5 * damping / mass;
    const double frequency = std::sqrt(stiffness / mass - decay * decay);
    const double a = start - middle;
    const double b = (start_velocity + decay * a) / frequency;
    return middle + std::exp(-decay * t) * (a * std::cos(frequency * t) + b * std::sin(frequency * t));
  }
};

/// The oscillator, moved by one of Sprung's integrators.
class OscillatorRun {
 public:
  OscillatorRun(const Oscillator& of, const IntegratorSettings& settings, double dt)
      : network_(make_pair(of.start, of.stiffness, of.rest_length, of.damping, true, of.mass)), dt_(dt) {
    network_.velocities(0, 1) = of.start_velocity;
    forces_.push_back(std::make_unique<SpringForce>(network_));
    forces_.push_back(std::make_unique<Gravity>(network_, Vector3(of.gravity, 0.0, 0.0)));
    state_ = initial_state(network_);
    integrator_ = make_integrator(settings, network_);
    integrator_->start(state_, forces_, dt_);
  }

  void step() {
    integrator_->advance(state_, forces_, dt_);
    ++state_.step;
  }
  [[nodiscard]] double x() const { return state_.x(0, 1); }
  [[nodiscard]] double v() const { return state_.v(0, 1); }

 private:
  SpringNetwork network_;
  Forces forces_;
  std::unique_ptr<Integrator> integrator_;
  SimulationState state_;
  double dt_;
};

}  // namespace sprung
