#include "dynamics/integrators/schemes.h"
#include "dynamics/integrators/verlet_kernel.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

#include <cmath>
#include <vector>

namespace sprung {
namespace {

/// Consecutive particles without a pinned one.
struct FreeRun {
  Index begin;
  Index count;
};

std::vector<FreeRun> free_runs(const SpringNetwork& network) {
  constexpr Index kMost = 4096;
  std::vector<FreeRun> runs;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_fixed(i)) continue;
    const bool follows = !runs.empty() && runs.back().begin + runs.back().count == i && runs.back().count < kMost;
    if (follows) {
      ++runs.back().count;
    } else {
      runs.push_back({i, 1});
    }
  }
  return runs;
}

std::vector<Index> pinned_particles(const SpringNetwork& network) {
  std::vector<Index> pinned;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_fixed(i)) pinned.push_back(i);
  }
  return pinned;
}

// Between steps state.v is (x - x_previous) / dt, so that forces and the dampers of neighbours see Verlet's velocity.
class Verlet final : public Integrator {
 public:
  Verlet(const VerletSettings& settings, const SpringNetwork& network)
      : Integrator(network), settings_(settings), free_runs_(free_runs(network)), pinned_(pinned_particles(network)) {}

  void resume(SimulationState& state, const Forces& forces, double dt) override {
    forces_are_constant_ = are_constant(forces);
    dt_of_gains_ = 0.0;
    evaluate(state, forces, dt, total_);
  }

  void start(SimulationState& state, const Forces& forces, double dt) override {
    Integrator::start(state, forces, dt);
    if (settings_.start_at_rest) return;
    for_free_particles(network(), [&](Index i) {
      state.x_previous.col(i) -= dt * state.v.col(i) - 0.5 * dt * dt * network().inverse_masses[i] * total_.col(i);
    });
  }

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    if (!dampers().empty()) {  // at the start, x_previous is not x - v dt
      undamped_ = state.v;
      dampers().apply(state.x, dt, state);
      for_free_particles(network(), [&](Index i) { state.x_previous.col(i) += dt * (undamped_.col(i) - state.v.col(i)); });
    }
    if (!forces_are_constant_) evaluate(state, forces, dt, total_);
    record(total_, dt, state);
    set_gains(dt);
    for (const Index i : pinned_) state.x_previous.col(i) = state.x.col(i);
    const VerletStep step{.kept = kept(dt, state.substeps), .per_dt = 1.0 / dt};
    for_free_runs([&](Index begin, Index count) {
      if (forces_are_constant_) {
        advance_verlet(3 * count, step, gained_.col(begin).data(), state.x.col(begin).data(), state.x_previous.col(begin).data(),
                       state.v.col(begin).data());
        return;
      }
      advance_verlet(3 * count, step, gains_.col(begin).data(), total_.col(begin).data(), state.x.col(begin).data(),
                     state.x_previous.col(begin).data(), state.v.col(begin).data());
    });
  }

  void recover_velocities(SimulationState& state, const Forces&, const Points& before, const Points&, double dt) override {
    for_free_runs([&](Index begin, Index count) {
      velocities_between(3 * count, 1.0 / dt, before.col(begin).data(), state.x.col(begin).data(), state.v.col(begin).data());
    });
  }

  [[nodiscard]] bool keeps_positions() const override { return true; }
  [[nodiscard]] bool needs_advanced() const override { return false; }

  void step_changed(SimulationState& state, const Forces& forces, double dt_before, double dt) override {
    if (!forces_are_constant_) evaluate(state, forces, dt, total_);
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) += 0.5 * (dt_before - dt) * network().inverse_masses[i] * total_.col(i);
      state.x_previous.col(i) = state.x.col(i) - dt * state.v.col(i);
    });
  }

  void velocity_changed(SimulationState& state, Index particle, double dt) const override {
    state.x_previous.col(particle) = state.x.col(particle) - dt * state.v.col(particle);
  }

 private:
  /// The fraction of the movement that is kept in one of `substeps` substeps of `dt` [s].
  [[nodiscard]] double kept(double dt, int substeps) const {
    const double kept = 1.0 - damping_per_step(settings_, dt);
    return substeps > 1 && settings_.damping_rate == 0.0 ? std::pow(kept, 1.0 / substeps) : kept;
  }

  /// dt^2 / m for each coordinate, and its product with constant forces.
  void set_gains(double dt) {
    if (dt == dt_of_gains_) return;
    dt_of_gains_ = dt;
    gains_ = (dt * dt * network().inverse_masses.transpose()).replicate(3, 1);
    if (forces_are_constant_) gained_ = gains_.cwiseProduct(total_);
  }

  template <class Body>
  void for_free_runs(Body&& body) const {
    parallel_chunks(static_cast<Index>(free_runs_.size()), 2, [&](Index begin, Index end) {
      for (Index run = begin; run < end; ++run) body(free_runs_[run].begin, free_runs_[run].count);
    });
  }

  VerletSettings settings_;
  std::vector<FreeRun> free_runs_;
  std::vector<Index> pinned_;
  Points total_;
  Points undamped_;
  bool forces_are_constant_ = false;
  Points gains_;
  Points gained_;
  double dt_of_gains_ = 0.0;
};

// The acceleration at the end of a step is not reused: dampers, constraints and contact change what it depends on.
class VelocityVerlet final : public Integrator {
 public:
  explicit VelocityVerlet(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    dampers().apply(state.x, dt, state);
    evaluate(state, forces, dt, total_);
    record(total_, 0.5 * dt, state);
    x_ = state.x;
    v_ = state.v;
    for_particles(network(), [&](Index i) {
      const Vector3 gained = dt * network().inverse_masses[i] * total_.col(i);
      x_.col(i) += dt * (v_.col(i) + 0.5 * gained);
      v_.col(i) += gained;
    });
    sum_forces(forces, {.x = x_, .v = v_, .time = step_begin(state, dt) + dt}, total_);
    record(total_, 0.5 * dt, state);
    for_free_particles(network(), [&](Index i) {
      state.x.col(i) = x_.col(i);
      state.v.col(i) = 0.5 * (state.v.col(i) + v_.col(i) + dt * network().inverse_masses[i] * total_.col(i));
    });
  }

  // Springs must not pull with a stretch that constraints removed (RATTLE, Andersen 1983).
  void recover_velocities(SimulationState& state, const Forces& forces, const Points& before, const Points& advanced,
                          double dt) override {
    if (state.x == advanced) return;
    Integrator::recover_velocities(state, forces, before, advanced, dt);
    for_free_particles(network(), [&](Index i) { v_.col(i) += (state.x.col(i) - advanced.col(i)) / dt; });
    sum_forces(forces, {.x = state.x, .v = v_, .time = step_begin(state, dt) + dt}, constrained_);
    record(constrained_, 0.5 * dt, state);
    record(total_, -0.5 * dt, state);
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) += 0.5 * dt * network().inverse_masses[i] * (constrained_.col(i) - total_.col(i));
    });
  }

 private:
  // The end of the last step as `advance` left it, and the velocities there if the forces did not change.
  Points x_;
  Points v_;
  Points total_;        // forces there
  Points constrained_;  // and the positions after constraints
};

}  // namespace

double damping_per_step(const VerletSettings& settings, double dt) {
  return settings.damping_rate > 0.0 ? -std::expm1(-settings.damping_rate * dt) : settings.damping;
}

std::unique_ptr<Integrator> make_verlet(const VerletSettings& settings, const SpringNetwork& network) {
  return std::make_unique<Verlet>(settings, network);
}

std::unique_ptr<Integrator> make_velocity_verlet(const SpringNetwork& network) { return std::make_unique<VelocityVerlet>(network); }

}  // namespace sprung
