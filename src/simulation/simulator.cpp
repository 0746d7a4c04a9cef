#include "simulation/simulator.h"

#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/constraints/carried_surface.h"
#include "dynamics/constraints/cell_volume.h"
#include "dynamics/constraints/enclosed_volume.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/shared_force.h"
#include "network/model/pin_schedule.h"
#include "network/model/sleeping_particles.h"
#include "network/model/spring_failure.h"
#include "simulation/settings/settings_check.h"
#include "simulation/settings/unused_settings.h"
#include "simulation/simulator_implementation.h"
#include "simulation/start/start.h"
#include "simulation/step/network_forces.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <utility>

namespace sprung {

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::shared_ptr<ObstacleSet> shared,
                                          External added)
    : network(std::move(model)),
      settings(checked_settings(std::move(chosen))),
      shared_obstacles(std::move(shared)),
      obstacles(*shared_obstacles),
      external(std::move(added)),
      bounds(simulation_bounds(network, settings, !obstacles.empty(), external.forces)),
      warnings(check_step(settings, bounds)),
      forces(
          network_forces(network, settings, splits_dampers(settings, bounds) ? MaterialDampers::apart : MaterialDampers::within)),
      integrator(make_integrator(settings.integrator, network)),
      constraints(network, settings, steady_acceleration(network, settings), obstacles, *integrator),
      pin_paths(network, obstacles.obstacles(), settings.step),
      planner(network, settings, constraints.limit()),
      divergence(network),
      energy_watch(network, settings, obstacles.obstacles(), forces),
      groups(network),
      rest(network, groups, constraints.limit(), settings.gravity.norm()),
      surroundings(network, obstacles, groups, settings.step, settings.gravity.norm()),
      state(initial_state(network)) {
  state.rest.sleepers = sleeping_groups();
  if (!constraints.contacts().can_collide()) state.contact.slip = {};  // each step copies the state
  state.steps_per_frame = settings.steps_per_frame;
  planner.start(anything_moves(), state);
  if (settings.perturb) symmetry.emplace(network, settings.seed);
  if (!network.attachments.empty()) {
    const bool implicit = std::holds_alternative<ImplicitEulerSettings>(settings.integrator);
    attachments.emplace(network, obstacles, settings.step, implicit);
  }
  if (splits_dampers(settings, bounds)) {
    const double most = most_damping_rate(settings.step);
    integrator->set_dampers(material_dampers(network, most), std::min(most, bounds.material_damping));
  }
  add_forces();
  add_constraints();
  for (const auto& more : {unused_settings(settings, network, obstacles.obstacles()), weak_springs(settings, network)}) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
}

/// Those that network_forces() does not make.
void Simulator::Implementation::add_forces() {
  if (acts_on_faces(network, settings)) {
    auto force =
        std::make_unique<SurfaceAirForce>(network, settings.air_surface, settings.wind, settings.gravity.norm(), air_step());
    surface_air = force.get();
    forces.push_back(std::move(force));
  }
  if (settings.contact.response == ContactSettings::Response::penalty && !obstacles.empty()) {
    auto force = std::make_unique<PenaltyContact>(network, obstacles, settings.contact.stiffness, settings.contact.damping, dt());
    penalty = force.get();
    forces.push_back(std::move(force));
  }
  if (attachments) forces.push_back(std::make_unique<SharedForce>(attachments->springs()));
  for (const std::shared_ptr<Force>& force : external.forces) forces.push_back(std::make_unique<SharedForce>(force));
}

void Simulator::Implementation::add_constraints() {
  if (std::ranges::any_of(network.bodies, [](const Body& body) { return !body.carried.empty(); })) {
    constraints.add(std::make_unique<CarriedSurface>(network));
  }
  if (std::ranges::any_of(network.bodies, &Body::preserve_volume)) constraints.add(std::make_unique<CellVolume>(network));
  if (std::ranges::any_of(network.bodies, [](const Body& body) { return body.volume_factor != 0.0; })) {
    constraints.add(std::make_unique<EnclosedVolume>(network));
  }
  if (attachments && std::ranges::any_of(network.attachments, &Attachment::is_rigid)) constraints.add_rods(attachments->rods());
  for (const std::shared_ptr<Constraint>& constraint : external.constraints) constraints.add(constraint);
}

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> given)
    : Implementation(std::move(model), std::move(chosen), std::make_shared<ObstacleSet>(std::move(given)), {}) {
  pin_paths.register_pins(state);
  move_pins(0.0);
  Start start = find_start(network, obstacles_now(), settings.contact, state.x);
  state.x = std::move(start.positions);
  warnings.insert(warnings.end(), start.warnings.begin(), start.warnings.end());
  notes = std::move(start.notes);
  if (constraints.violation(state.x) > 1.0) correct_positions(dt());
  if (attachments) attachments->update(state);
  const std::vector<std::string> of_links = unlikely_lengths(network, state.links);
  warnings.insert(warnings.end(), of_links.begin(), of_links.end());
  integrator->start(state, forces, dt());
  note_change();
  if (attachments) EnergyWatch::note_pin(attachments->winch_speed(state), state.energy);
  begin_recording();
}

void Simulator::Implementation::correct_positions(double dt) {
  constraints.correct_positions(obstacles_now(), state, dt);
  state.contact.permitted_crossings = constraints.permitted_crossings();
}

/// Before this, pins take the speed with which they begin, which is no impulse.
void Simulator::Implementation::begin_recording() {
  if (!settings.record_forces) return;
  reactions.reset();
  forces_since = time();
  state.impulses = {.on_pinned = Points::Zero(3, network.particle_count()), .of_springs = Scalars::Zero(network.springs.count())};
  if (!state.last_impulses.on()) state.last_impulses = state.impulses;
}

/// Whether anything moves at the start, when the rotation in a step is not known yet.
bool Simulator::Implementation::anything_moves() const {
  return !network.velocities.isZero(0.0) || std::ranges::any_of(network.pins, &Pin::moves);
}

Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
    : implementation_(std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(obstacles))) {}
Simulator::Simulator(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

StepReport Simulator::step() {
  std::unique_ptr<Implementation> before;
  const std::vector<char> sleepers = state().rest.sleepers;
  try {
    return step_and_rebuild(before);
  } catch (...) {
    if (before) implementation_ = std::move(before);
    implementation_->state.rest.sleepers = sleepers;  // fewer, if the step was repeated with some of them awake
    throw;
  }
}

/// A rebuilt simulator leaves the first one in `before`.
StepReport Simulator::step_and_rebuild(std::unique_ptr<Implementation>& before) {
  const Implementation& now = *implementation_;
  const std::vector<Index> broken = breaking_springs(now.network, now.state.x);
  if (!broken.empty() || now.state.rest.sleepers != now.sleeping_groups() ||
      have_pins_changed(now.network, due_before(whole_steps(now.state), now.settings.step))) {
    SpringNetwork network = now.network;
    set_asleep(broken.empty() ? now.particles_to_sleep() : std::vector<char>(), network);
    const std::vector<Index> left = tear(network, broken);
    before = rebuild(std::move(network), left);
    if (!broken.empty()) implementation_->wake_all();
  }
  std::optional<StepReport> report = implementation_->step(PlanReason::first);
  while (!report) {
    std::unique_ptr<Implementation> asleep = rebuild(implementation_->particles_to_sleep());
    if (!before) before = std::move(asleep);
    report = implementation_->step(PlanReason::wake);
  }
  return *report;
}

void Simulator::stop_when(std::function<bool()> stops) { implementation_->stops = std::move(stops); }
const SpringNetwork& Simulator::network() const { return implementation_->network; }
const SimulatorSettings& Simulator::settings() const { return implementation_->settings; }
const SimulationState& Simulator::state() const { return implementation_->state; }
const std::vector<Obstacle>& Simulator::obstacles() const { return implementation_->obstacles.obstacles(); }
ObstacleFrame Simulator::obstacle_frame() const { return implementation_->obstacles_now(); }
const std::vector<std::string>& Simulator::warnings() const { return implementation_->warnings; }

const std::vector<std::string>& Simulator::notes() const { return implementation_->notes; }
double Simulator::time() const { return implementation_->time(); }
double Simulator::gravity_energy() const { return implementation_->energy(EnergyKind::gravity); }
double Simulator::elastic_energy() const { return implementation_->energy(EnergyKind::elastic); }
double Simulator::contact_energy() const { return implementation_->energy(EnergyKind::contact); }

std::vector<Reaction> Simulator::reactions() const {
  if (!state().impulses.on()) return {};
  return implementation_->reactions.reactions(network(), state().impulses, time() - implementation_->forces_since);
}

Scalars Simulator::limit_tensions() const {
  const double duration = time() - implementation_->forces_since;
  if (!state().impulses.on() || duration <= 0.0) return Scalars::Zero(network().springs.count());
  return state().impulses.of_springs / duration;
}

void Simulator::reset_forces() { implementation_->begin_recording(); }

std::string Simulator::stretch_solver() const {
  const StretchLimit* limit = implementation_->constraints.limit();
  return limit != nullptr ? limit->chosen_solver() : std::string();
}

std::vector<BrokenLink> Simulator::broken_links() const {
  std::vector<BrokenLink> broken;
  for (const Link& link : state().links) {
    if (link.broken) broken.push_back({network().attachments[link.attachment].name, link.first, *link.broken});
  }
  return broken;
}

std::vector<Index> Simulator::contact_particles() const { return implementation_->contacts(); }
Index Simulator::contact_count() const { return static_cast<Index>(contact_particles().size()); }

void Simulator::check() const {
  if (const auto failure = implementation_->divergence.overstretched(state().x)) implementation_->fail(*failure);
  if (implementation_->external.empty()) implementation_->check_energy(implementation_->energies());
}

}  // namespace sprung
