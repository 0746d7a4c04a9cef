#include "simulation/simulator.h"

#include "collision/obstacles/obstacle_set.h"
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
#include "simulation/step/limit_handover.h"
#include "simulation/step/network_forces.h"
#include "simulation/step/step_check.h"
#include "simulation/step/step_retry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sprung {
namespace {

// Springs are checked for overstretching at about this rate: each step in small networks, less often in large ones.
constexpr Index kSpringsCheckedPerStep = 8192;

// Energies cost more and take many steps to explode, so they are checked less often.
constexpr Index kStepsPerEnergy = 64;

// Largest rotation of an obstacle or a pin in a substep [degrees].
constexpr double kMaxTurn = 45.0;

}  // namespace

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::shared_ptr<Environment> shared,
                                          External added)
    : network(std::move(model)),
      settings(checked_settings(std::move(chosen))),
      shared_environment(std::move(shared)),
      environment(*shared_environment),
      external(std::move(added)),
      bounds(simulation_bounds(network, settings, !environment.obstacles().empty(), external.forces)),
      warnings(check_step(settings, bounds)),
      forces(
          network_forces(network, settings, splits_dampers(settings, bounds) ? MaterialDampers::apart : MaterialDampers::within)),
      integrator(make_integrator(settings.integrator, network)),
      constraints(network, settings, steady_acceleration(network, settings), environment, *integrator),
      pin_paths(network, environment.obstacles(), settings.step),
      waits_for_turn(constraints.limit() != nullptr && constraints.limit()->may_follow_turn()),
      divergence(network),
      energy_watch(network, settings, environment.obstacles(), forces),
      patches(network),
      rest(network, patches, constraints.limit(), settings.gravity.norm()),
      surroundings(network, environment, patches, settings.step, settings.gravity.norm()),
      state(initial_state(network)) {
  state.rest.sleepers = sleeping_patches();
  const StretchLimit* limit = constraints.limit();
  if (limit != nullptr && settings.max_substeps > 1) {
    refinement.emplace(limit->settings(), settings.max_substeps);
    if (waits_for_turn || (limit->follows_turn() && anything_moves())) state.substeps = settings.max_substeps;
  }
  if (settings.perturb) symmetry.emplace(network, settings.seed);
  if (!network.attachments.empty()) {
    const bool implicit = std::holds_alternative<ImplicitEulerSettings>(settings.integrator);
    attachments.emplace(network, environment, settings.step, implicit);
  }
  if (splits_dampers(settings, bounds)) {
    const double most = most_damping_rate(settings.step);
    integrator->set_dampers(material_dampers(network, most), std::min(most, bounds.material_damping));
  }
  add_forces();
  add_constraints();
  for (const auto& more : {unused_settings(settings, network, environment.obstacles()), weak_springs(settings, network)}) {
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
  if (settings.contact.response == ContactSettings::Response::penalty && !environment.obstacles().empty()) {
    auto force = std::make_unique<PenaltyContact>(network, environment, settings.contact.stiffness, settings.contact.damping, dt());
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

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> obstacles)
    : Implementation(std::move(model), std::move(chosen), std::make_shared<Environment>(std::move(obstacles)), {}) {
  environment.set_interval(0.0, 0.0);
  pin_paths.take(state);
  move_pins(0.0);
  Start start = find_start(network, environment, settings.contact, state.x);
  state.x = std::move(start.positions);
  warnings.insert(warnings.end(), start.warnings.begin(), start.warnings.end());
  notes = std::move(start.notes);
  if (constraints.violation(state.x) > 1.0) constraints.correct_positions(state, dt());
  if (attachments) attachments->update(state);
  const std::vector<std::string> of_links = unlikely_lengths(network, state.links);
  warnings.insert(warnings.end(), of_links.begin(), of_links.end());
  integrator->start(state, forces, dt());
  note_change();
  if (attachments) EnergyWatch::note_pin(attachments->winch_speed(state), state.energy);
  begin_recording();
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

std::optional<StepReport> Simulator::Implementation::step() {
  if (all_sleep()) {
    const RecordedImpulses impulses_before = state.impulses;
    ++state.step;
    if (environment.set().moves()) environment.set_interval(time(), time());
    add_impulses_of_sleepers(impulses_before);
    record_attachments();
    if (environment.set().moves()) choose_sleepers();
    return StepReport{};
  }
  begin.state = state;
  begin.crossings = constraints.permitted_crossings();
  try {
    return step_from_begin();
  } catch (...) {
    return_to(begin.state, begin.crossings);
    throw;
  }
}

std::optional<StepReport> Simulator::Implementation::step_from_begin() {
  const std::optional<std::size_t> compared = body_to_compare(state);
  const std::vector<PatchPair> pairs = network.asleep.empty() ? std::vector<PatchPair>() : surroundings.find(state).pairs;
  const int factor = factor_for_rotation();
  StepReport report = make_step(factor, std::numeric_limits<Index>::max());
  if (disturbs_sleep(pairs)) {
    const std::vector<char> sleepers = state.rest.sleepers;
    return_to(begin.state, begin.crossings);
    state.rest.sleepers = sleepers;
    return std::nullopt;
  }
  if (may_retry(report.max_infeasible, begin.state)) report = repeat_step(report, factor);
  if (compared) report = compare_solvers(*compared, report, factor);
  note_step(report.infeasible, state);
  let_yield(network.springs, state.x);
  if (refinement) choose_substeps(report);
  if (const StretchLimit* limit = constraints.limit()) note_missed(network, *limit, report.stretch_excess, state);
  record_attachments();
  const bool breaks = attachments && attachments->break_overloaded(state);
  if (breaks) integrator->resume(state, forces, dt());
  add_impulses_of_sleepers(begin.state.impulses);
  choose_sleepers();
  if (breaks) wake_all();
  return report;
}

/// What changes between two steps, at the begin of each attempt.
void Simulator::Implementation::prepare_step() {
  update_attachments();
  if (symmetry && constraints.contacts().can_collide() && symmetry->may_push(state.x)) {
    symmetry->push(contact_normals(), dt(), *integrator, state);
  }
}

/// An implicit scheme finds the pattern of its matrix anew. Springs that engage at another length than theirs bring energy.
void Simulator::Implementation::update_attachments() {
  if (!attachments || !attachments->update(state)) return;
  integrator->resume(state, forces, dt());
  note_change();
  EnergyWatch::note_pin(attachments->winch_speed(state), state.energy);
}

/// After each step.
void Simulator::Implementation::record_attachments() {
  if (!attachments || !state.impulses.on()) return;
  for (const Link& link : state.links) {
    reactions.add(network.attachments[link.attachment].name, settings.step * attachments->force_of(link, state));
  }
}

/// In the frame of a rotating obstacle, particles are assumed to move straight in a substep: after half a turn, through its center.
int Simulator::Implementation::factor_for_rotation() const {
  const double start = time();
  double turn = 0.0;
  for (const Obstacle& obstacle : environment.obstacles())
    turn = std::max(turn, obstacle.motion.turn(start, start + settings.step));
  for (const Pin& pin : network.pins) {
    if (pin.obstacle == kNone) turn = std::max(turn, pin.motion.turn(start, start + settings.step));
  }
  const double needed = std::ceil(turn / (kMaxTurn * state.substeps));
  return static_cast<int>(
      std::clamp(needed, 1.0, static_cast<double>(std::min(kRetryFactors.back(), kMaxSubsteps / state.substeps))));
}

/// Makes the step with `factor` times the substeps. Ends early after a substep with at least `max_infeasible` infeasible particles.
StepReport Simulator::Implementation::make_step(int factor, Index max_infeasible) {
  prepare_step();
  const int substeps = state.substeps;
  integrator->set_fraction(1.0 / factor);
  set_substeps(factor * substeps);
  StepReport report;
  for (const std::int64_t step = state.step; state.step == step && report.max_infeasible < max_infeasible;) {
    if (stops && stops()) throw StoppedError();
    report += make_substep();
  }
  if (const StretchLimit* limit = constraints.limit()) report.turn = factor * limit->turn();
  note_contacts();
  integrator->set_fraction(1.0);
  set_substeps(substeps);
  return report;
}

StepReport Simulator::Implementation::make_substep() {
  const double t = time();
  const double t_end = (static_cast<double>(state.step) + static_cast<double>(state.substep + 1) / state.substeps) * settings.step;
  constraints.begin(state);
  integrator->advance(state, forces, dt());
  environment.set_interval(t, t_end);
  move_pins(t_end);
  energy_watch.note_obstacle(environment.set().max_displacement(state.x) / dt(), state.energy);

  StepReport report{.substeps = 1};
  constraints.apply(state, forces, dt(), t_end, report);
  if (attachments) attachments->note_substep(dt(), t_end, state);
  if (++state.substep == state.substeps) {
    ++state.step;
    state.substep = 0;
  }
  if (penalty != nullptr) environment.set_interval(t_end, t_end);
  check_state();
  return report;
}

void Simulator::Implementation::choose_substeps(const StepReport& report) {
  const double dt_before = dt();
  const StretchLimit& limit = *constraints.limit();
  if (limit.follows_turn(state.stretch_handovers)) {
    refinement->choose_by_turn(report.turn, state);
  } else if (waits_for_turn) {
    state.substeps = settings.max_substeps;  // which the solve did not need before the body came back
  } else {
    refinement->choose(report.stretch_excess, state);
  }
  substep_changed(dt_before);
}

void Simulator::Implementation::set_substeps(int substeps) {
  const double dt_before = dt();
  state.substeps = substeps;
  substep_changed(dt_before);
}

void Simulator::Implementation::substep_changed(double dt_before) {
  if (dt() == dt_before) return;
  step_length_changed();
  move_pins(time());
  if (steps_done(state) == 0.0) {
    integrator->start(state, forces, dt());
  } else {
    integrator->step_changed(state, forces, dt_before, dt());
  }
}

void Simulator::Implementation::move_pins(double time) {
  const Points v_before = state.impulses.on() ? state.v : Points();
  EnergyWatch::note_pin(pin_paths.move(time, dt(), state), state.energy);
  if (!state.impulses.on()) return;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_pinned(i)) record_gain(i, v_before.col(i));
  }
}

/// Its pin, not what acts on the particle, changed the velocity. Requires that the state records impulses.
void Simulator::Implementation::record_gain(Index particle, const Vector3& velocity_before) {
  state.impulses.on_pinned.col(particle) -= network.masses[particle] * (state.v.col(particle) - velocity_before);
}

/// Tells the forces that depend on the step.
void Simulator::Implementation::step_length_changed() {
  if (penalty != nullptr) penalty->set_step(dt());
  if (surface_air != nullptr) surface_air->set_step(air_step());
}

/// The step as SurfaceAirForce takes it.
double Simulator::Implementation::air_step() const {
  return std::holds_alternative<ImplicitEulerSettings>(settings.integrator) ? 0.0 : dt();
}

std::vector<ContactNormal> Simulator::Implementation::contact_normals() const {
  return penalty != nullptr ? penalty->normals(state.x) : state.contact.normals;
}

std::vector<Index> Simulator::Implementation::contacts() const {
  return penalty != nullptr ? penalty->touching(state.x) : state.contact.pushed;
}

/// At the end of a step.
void Simulator::Implementation::note_contacts() {
  if (penalty != nullptr || !constraints.contacts().can_collide()) return;
  std::vector<Index> asleep;
  std::ranges::copy_if(state.contact.pushed, std::back_inserter(asleep), [&](Index i) { return network.is_asleep(i); });
  state.contact.pushed.clear();
  std::ranges::merge(constraints.contacts().pushed(), asleep, std::back_inserter(state.contact.pushed));
  state.contact.normals = constraints.contacts().normals();
}

void Simulator::Implementation::check_state() {
  if (const auto failure = divergence.not_finite(state, constraints.positions_before(state))) fail(*failure);
  const Index check_interval = 1 + network.springs.count() / kSpringsCheckedPerStep;
  if (state.step % check_interval == 0) {
    if (const auto failure = divergence.overstretched(state.x)) fail(*failure);
  }
  if (state.step > 1 && state.step % (kStepsPerEnergy * check_interval) != 0) return;
  if (!external.empty()) return;
  const Energies now = energies();
  EnergyWatch::note(state.step, now, state.energy);
  check_energy(now);
}

void Simulator::Implementation::check_energy(const Energies& now) const {
  const auto explosion = energy_watch.explosion(now, state.energy);
  if (!explosion) return;
  StepFailure failure = divergence.fastest(state);
  failure.cause = *explosion + (failure.cause.empty() ? "" : "; " + failure.cause);
  fail(std::move(failure));
}

Energies Simulator::Implementation::energies() const {
  return {.kinetic = 0.5 * network.masses.dot(state.v.colwise().squaredNorm().transpose()),
          .elastic = energy(EnergyKind::elastic),
          .gravity = energy(EnergyKind::gravity),
          .contact = energy(EnergyKind::contact)};
}

void Simulator::Implementation::fail(StepFailure failure) const {
  failure.step = state.step;
  failure.time = time();
  set_divergence_remedy(settings, bounds, failure);
  throw StepError(std::move(failure));
}

StepReport& StepReport::operator+=(const StepReport& substep) {
  substeps += substep.substeps;
  iterations += substep.iterations;
  limit_solves += substep.limit_solves;
  stretch_excess = std::max(stretch_excess, substep.stretch_excess);
  truncated += substep.truncated;
  infeasible += substep.infeasible;
  max_infeasible = std::max(max_infeasible, substep.infeasible);
  return *this;
}

Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
    : implementation_(std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(obstacles))) {}
Simulator::Simulator(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

StepReport Simulator::step() {
  std::unique_ptr<Implementation> before;
  try {
    return step_and_rebuild(before);
  } catch (...) {
    if (before) implementation_ = std::move(before);
    throw;
  }
}

/// A rebuilt simulator leaves the first one in `before`.
StepReport Simulator::step_and_rebuild(std::unique_ptr<Implementation>& before) {
  const Implementation& now = *implementation_;
  const std::vector<Index> broken = breaking_springs(now.network, now.state.x);
  if (!broken.empty() || now.state.rest.sleepers != now.sleeping_patches() ||
      have_pins_changed(now.network, due_before(now.state.step, now.settings.step))) {
    SpringNetwork network = now.network;
    set_asleep(broken.empty() ? now.particles_to_sleep() : std::vector<char>(), network);
    const std::vector<Index> left = tear(network, broken);
    before = rebuild(std::move(network), left);
    if (!broken.empty()) implementation_->wake_all();
  }
  std::optional<StepReport> report = implementation_->step();
  while (!report) {
    std::unique_ptr<Implementation> asleep = rebuild(implementation_->particles_to_sleep());
    if (!before) before = std::move(asleep);
    report = implementation_->step();
  }
  return *report;
}

void Simulator::stop_when(std::function<bool()> stops) { implementation_->stops = std::move(stops); }
const SpringNetwork& Simulator::network() const { return implementation_->network; }
const SimulatorSettings& Simulator::settings() const { return implementation_->settings; }
const SimulationState& Simulator::state() const { return implementation_->state; }
const Environment& Simulator::environment() const { return implementation_->environment; }
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
