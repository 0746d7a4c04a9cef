#include "dynamics/integrators/integrator.h"

#include "dynamics/integrators/constrained_directions.h"
#include "dynamics/integrators/schemes.h"
#include "dynamics/integrators/step_motion.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

namespace sprung {
namespace {

struct MakeIntegrator {
  const SpringNetwork& network;

  std::unique_ptr<Integrator> operator()(const ExplicitEulerSettings&) const { return make_explicit_euler(network); }
  std::unique_ptr<Integrator> operator()(const SymplecticEulerSettings&) const { return make_symplectic_euler(network); }
  std::unique_ptr<Integrator> operator()(const VerletSettings& verlet) const { return make_verlet(verlet, network); }
  std::unique_ptr<Integrator> operator()(const VelocityVerletSettings&) const { return make_velocity_verlet(network); }
  std::unique_ptr<Integrator> operator()(const RungeKutta4Settings&) const { return make_runge_kutta4(network); }
  std::unique_ptr<Integrator> operator()(const ImplicitEulerSettings&) const { return make_implicit_euler(network); }
};

}  // namespace

void Integrator::resume(SimulationState&, const Forces&, double) {}

void Integrator::start(SimulationState& state, const Forces& forces, double dt) {
  state.x_previous = state.x;
  resume(state, forces, dt);
}

void Integrator::step_changed(SimulationState&, const Forces&, double, double) {}

bool Integrator::respond_to_contact(const StepMotion&, const Forces&, const Points&, const ConstrainedDirections&,
                                    SimulationState&) {
  return false;
}

void Integrator::record_contact(const StepMotion&, const Points&, SimulationState&) const {}

void Integrator::recover_velocities(SimulationState& state, const Forces&, const Points&, const Points& advanced, double dt) {
  for_free_particles(network_, [&](Index i) { state.v.col(i) += (state.x.col(i) - advanced.col(i)) / dt; });
}

void Integrator::record(const Points& forces, double dt, SimulationState& state) const {
  if (!state.impulses.on()) return;
  for (Index i = 0; i < network_.particle_count(); ++i) {
    if (network_.is_fixed(i)) state.impulses.on_pinned.col(i) += dt * forces.col(i);
  }
}

void Integrator::velocity_changed(SimulationState&, Index, double) const {}

std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings, const SpringNetwork& network) {
  return std::visit(MakeIntegrator{network}, settings);
}

}  // namespace sprung
