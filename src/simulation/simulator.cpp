#include "simulation/simulator.h"

#include "dynamics/body_forces.h"
#include "dynamics/contact_projection.h"
#include "dynamics/penalty_contact.h"
#include "dynamics/spring_force.h"
#include "simulation/divergence.h"
#include "simulation/step_check.h"

#include <utility>

namespace sprung {
namespace {

// Passes of contact when no stretch limit asks for more: enough for a particle in a corner between obstacles to settle.
constexpr int kContactPasses = 8;

// Passes end when none pushes a particle by more than this part of its gap.
constexpr double kContactTolerance = 1.0e-3;

// Springs are looked at for one that gave way each step, large networks less often: about so many springs a step.
constexpr Index kSpringsCheckedPerStep = 8192;

}  // namespace

struct Simulator::Implementation {
  Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> obstacles);

  StepReport step();
  void move_pins(double time);
  void constrain(StepReport& report);
  void settle(StepReport& report);
  void check() const;

  SpringNetwork network;
  SimulatorSettings settings;
  Environment environment;
  SpectralBounds bounds;
  std::vector<std::string> warnings;
  Forces forces;
  std::unique_ptr<Integrator> integrator;
  std::optional<StretchLimit> limit;
  ContactProjection contacts;
  DivergenceCheck divergence;
  SimulationState state;

  // Within a step: where it began, and where the forces alone would have ended it.
  Points before;
  Points v_before;
  Points advanced;
  Points scratch;
};

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> obstacles)
    : network(std::move(model)),
      settings(std::move(chosen)),
      environment(std::move(obstacles)),
      bounds(simulation_bounds(network, settings, !environment.obstacles().empty())),
      warnings(check_step(settings, bounds)),
      integrator(make_integrator(settings.integrator, network)),
      contacts(network, environment),
      divergence(network),
      state(initial_state(network)) {
  forces.push_back(std::make_unique<Gravity>(network, settings.gravity));
  forces.push_back(std::make_unique<SpringForce>(network));
  if (settings.air_drag > 0.0) forces.push_back(std::make_unique<AirDrag>(network, settings.air_drag, settings.wind));
  if (settings.contact.response == ContactSettings::Response::penalty && !environment.obstacles().empty()) {
    forces.push_back(std::make_unique<PenaltyContact>(network, environment, settings.contact.stiffness, settings.contact.damping,
                                                      settings.step));
  }
  if (settings.stretch_limit) limit.emplace(network, *settings.stretch_limit);
  environment.set_interval(0.0, 0.0);
  refuse_inside(network, environment, state.x);
  move_pins(0.0);
  integrator->start(state, forces, settings.step);
}

StepReport Simulator::Implementation::step() {
  const double t = static_cast<double>(state.step) * settings.step;
  const double t_end = static_cast<double>(state.step + 1) * settings.step;
  before = state.x;
  v_before = state.v;

  environment.set_interval(t, t);
  integrator->advance(state, forces, settings.step, scratch);
  environment.set_interval(t, t_end);
  move_pins(t_end);
  advanced = state.x;

  StepReport report;
  constrain(report);
  settle(report);
  ++state.step;
  check();
  return report;
}

// A pin's velocity is that of the step to come: what its neighbours' dampers see.
void Simulator::Implementation::move_pins(double time) {
  for (const Pin& pin : network.pins) {
    if (!pin.motion.moves()) continue;
    const RigidTransform origin(Eigen::Translation3d(pin.origin));
    const RigidTransform now = pin.motion.pose(origin, time) * origin.inverse();
    const RigidTransform next = pin.motion.pose(origin, time + settings.step) * origin.inverse();
    for (const Index i : pin.particles) {
      const Vector3 start = network.positions.col(i);
      state.x.col(i) = now * start;
      state.v.col(i) = (next * start - state.x.col(i)) / settings.step;
    }
  }
}

void Simulator::Implementation::constrain(StepReport& report) {
  const bool projects = settings.contact.response == ContactSettings::Response::projection && !environment.obstacles().empty();
  if (!projects && !limit) return;
  if (projects) contacts.find(before, v_before, state, settings.step);
  const int passes = limit ? limit->settings().iterations : kContactPasses;
  bool settled = false;
  while (!settled && report.iterations < passes) {
    const double excess = limit ? limit->project(state.x) : 0.0;
    const double push = projects ? contacts.project(state.x) : 0.0;
    settled = (!limit || excess <= limit->settings().tolerance) && push <= kContactTolerance;
    ++report.iterations;
  }
}

void Simulator::Implementation::settle(StepReport& report) {
  if (environment.obstacles().empty() && !limit) return;
  if (!environment.obstacles().empty()) contacts.truncate(before, state.x);
  integrator->recover_velocities(state, before, advanced, settings.step);
  if (!environment.obstacles().empty()) contacts.settle_velocities(state, *integrator);
  report.stretch_excess = limit ? limit->excess(state.x) : 0.0;
  report.contacts = contacts.contact_count();
  report.truncated = contacts.truncated_count();
  report.squeezed = contacts.squeezed_count();
}

void Simulator::Implementation::check() const {
  std::optional<StepFailure> failure = divergence.not_finite(state, before);
  const Index check_interval = 1 + network.springs.count() / kSpringsCheckedPerStep;
  if (!failure && state.step % check_interval == 0) failure = divergence.overstretched(state.x);
  if (!failure) return;
  failure->step = state.step;
  failure->time = static_cast<double>(state.step) * settings.step;
  failure->remedy = divergence_remedy(settings, bounds);
  throw StepError(std::move(*failure));
}

Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
    : implementation_(std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(obstacles))) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

StepReport Simulator::step() { return implementation_->step(); }
const SpringNetwork& Simulator::network() const { return implementation_->network; }
const SimulatorSettings& Simulator::settings() const { return implementation_->settings; }
const SimulationState& Simulator::state() const { return implementation_->state; }
const Environment& Simulator::environment() const { return implementation_->environment; }
const std::vector<std::string>& Simulator::warnings() const { return implementation_->warnings; }
double Simulator::time() const { return static_cast<double>(state().step) * settings().step; }
double Simulator::elastic_energy() const { return implementation_->forces[1]->energy(state().x); }
double Simulator::gravity_energy() const { return implementation_->forces[0]->energy(state().x); }

}  // namespace sprung
