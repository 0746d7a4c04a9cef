#include "dynamics/integrators/schemes.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

#include <array>

namespace sprung {
namespace {

/// A stage: its time as a fraction of the step, its weight in the mean, and the fraction of the step to the next stage.
struct Stage {
  double time;
  double weight;
  double reach;
};
constexpr std::array<Stage, 4> kStages{
    {{0.0, 1.0 / 6.0, 0.5}, {0.5, 1.0 / 3.0, 0.5}, {0.5, 1.0 / 3.0, 1.0}, {1.0, 1.0 / 6.0, 0.0}}};

class RungeKutta4 final : public Integrator {
 public:
  explicit RungeKutta4(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    dampers().apply(state.x, dt, state);
    const auto n = state.x.cols();
    x_ = state.x;
    v_ = state.v;
    velocity_.setZero(3, n);
    acceleration_.setZero(3, n);
    for (const Stage& stage : kStages) {
      sum_forces(forces, {.x = x_, .v = v_, .time = step_begin(state, dt) + stage.time * dt}, total_);
      record(total_, stage.weight * dt, state);
      add_slope(stage, state, dt);
    }
    for_free_particles(network(), [&](Index i) {
      state.x.col(i) += dt * velocity_.col(i);
      state.v.col(i) += dt * acceleration_.col(i);
    });
  }

 private:
  /// Adds the stage's slope to the mean and moves to the next stage.
  void add_slope(const Stage& stage, const SimulationState& state, double dt) {
    const double reach = stage.reach * dt;
    for_particles(network(), [&](Index i) {
      const Vector3 v = v_.col(i);
      const Vector3 a = network().inverse_masses[i] * total_.col(i);
      velocity_.col(i) += stage.weight * v;
      acceleration_.col(i) += stage.weight * a;
      x_.col(i) = state.x.col(i) + reach * v;
      v_.col(i) = state.v.col(i) + reach * a;
    });
  }

  Points x_;  // at the stage
  Points v_;
  Points velocity_;  // means over the step
  Points acceleration_;
  Points total_;
};

}  // namespace

std::unique_ptr<Integrator> make_runge_kutta4(const SpringNetwork& network) { return std::make_unique<RungeKutta4>(network); }

}  // namespace sprung
