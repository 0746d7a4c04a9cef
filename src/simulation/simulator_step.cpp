// The step: its attempts, their substeps, and the check of the state.
#include "base/error.h"
#include "collision/obstacles/obstacle_frame.h"
#include "network/model/spring_failure.h"
#include "simulation/simulator_implementation.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sprung {
namespace {

// Springs are checked for overstretching at about this rate: each step in small networks, less often in large ones.
constexpr Index kSpringsCheckedPerStep = 8192;

// Energies cost more and take many steps to explode, so they are checked less often.
constexpr Index kStepsPerEnergy = 64;

}  // namespace

std::optional<StepReport> Simulator::Implementation::step(PlanReason reason) {
  if (all_sleep()) {
    const RecordedImpulses impulses_before = state.impulses;
    count_step(state);
    add_impulses_of_sleepers(impulses_before);
    record_attachments();
    if (obstacles.moves()) choose_sleepers();
    return StepReport{};
  }
  begin = state;
  try {
    return step_from_begin(reason);
  } catch (...) {
    return_to(begin);
    throw;
  }
}

std::optional<StepReport> Simulator::Implementation::step_from_begin(PlanReason reason) {
  const std::vector<GroupPair> pairs = network.asleep.empty() ? std::vector<GroupPair>() : surroundings.find(state).pairs;
  StepPlan plan = planner.first(state, rotation_in_step());
  if (reason == PlanReason::wake) plan.reason = reason;
  std::vector<StepTrial> tried{make_trial(plan)};
  if (disturbs_sleep(pairs)) {
    const std::vector<char> sleepers = state.rest.sleepers;
    return_to(begin);
    state.rest.sleepers = sleepers;
    return std::nullopt;
  }
  while (const auto next = planner.next(tried, begin)) {
    if (planner.best(tried) + 1 == tried.size()) best = state;
    return_to(begin);
    tried.push_back(repeat(*next));
  }
  const std::size_t number = planner.best(tried);
  if (number + 1 != tried.size()) return_to(best);
  finish_step(tried);
  StepReport report = tried[number].report;
  report.reason = tried[number].plan.reason;
  return report;
}

/// The state is that of the best attempt.
void Simulator::Implementation::finish_step(std::span<const StepTrial> tried) {
  let_yield(network.springs, state.x);
  const double dt_before = dt();
  planner.learn(tried, state);
  substep_changed(dt_before);
  record_attachments();
  const bool breaks = attachments && attachments->break_overloaded(state);
  if (breaks) integrator->resume(state, forces, dt());
  add_impulses_of_sleepers(begin.impulses);
  choose_sleepers();
  if (breaks) wake_all();
}

/// Continues from a former state of this step.
void Simulator::Implementation::return_to(const SimulationState& former) {
  state = former;
  constraints.roll_back(state.contact.permitted_crossings);
  step_length_changed();
  if (penalty != nullptr) penalty->prepare(time());
  if (attachments) attachments->load(state, time());
}

StepTrial Simulator::Implementation::repeat(const StepPlan& plan) {
  try {
    return make_trial(plan);
  } catch (const StepError&) {
    return {.plan = plan, .report = {}, .is_complete = false};
  }
}

/// Throws StepError if it diverges.
StepTrial Simulator::Implementation::make_trial(const StepPlan& plan) {
  if (plan.trial) {
    state.limit.handovers[plan.trial->body].solved_since = plan.trial->newton ? std::optional(state.step) : std::nullopt;
  }
  constraints.follow(plan);
  prepare_step();
  const int planned = state.substeps;
  set_substeps(plan.substeps());
  StepTrial trial{.plan = plan, .report = {}};
  for (const std::int64_t step = state.step; state.step == step && trial.report.max_infeasible < plan.abandon_at;) {
    if (stops && stops()) throw StoppedError();
    trial.report += make_substep();
  }
  note_contacts();
  set_substeps(planned);
  trial.is_complete = trial.report.max_infeasible < plan.abandon_at;
  const auto body = planner.body_to_compare(begin);
  if (body) trial.body_excess = constraints.limit()->excess(state.x, network.bodies[*body]);
  return trial;
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

/// The largest rotation of an obstacle or a pin [degrees].
double Simulator::Implementation::rotation_in_step() const {
  const double now = time();
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles.obstacles()) {
    largest = std::max(largest, obstacle.motion.rotation(now, now + settings.step));
  }
  for (const Pin& pin : network.pins) {
    if (pin.obstacle == kNone) largest = std::max(largest, pin.motion.rotation(now, now + settings.step));
  }
  return largest;
}

StepReport Simulator::Implementation::make_substep() {
  const double t = time();
  const double t_end =
      (static_cast<double>(whole_steps(state)) + static_cast<double>(state.substep + 1) / state.substeps) * settings.step;
  constraints.begin(state);
  integrator->advance(state, forces, dt());
  const ObstacleFrame frame(obstacles, t, t_end);
  move_pins(t_end);
  energy_watch.note_obstacle(frame.max_displacement(state.x) / dt(), state.energy);

  StepReport report{.substeps = 1};
  constraints.apply(frame, state, forces, dt(), report);
  if (attachments) attachments->note_substep(dt(), t_end, state);
  if (++state.substep == state.substeps) {
    count_step(state);
    state.substep = 0;
  }
  if (penalty != nullptr) penalty->prepare(t_end);
  check_state();
  return report;
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
  state.contact.permitted_crossings = constraints.permitted_crossings();
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
  deformation = substep.deformation;
  return *this;
}

}  // namespace sprung
