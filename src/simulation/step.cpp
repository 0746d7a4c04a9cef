// The step: its attempts, their substeps, and the check of the state.
#include "base/error.h"
#include "collision/obstacles/obstacle_frame.h"
#include "network/model/spring_failure.h"
#include "network/model/unloading.h"
#include "simulation/step/step_check.h"
#include "simulation/stepper.h"

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

StepReport Stepper::step() {
  const std::vector<Index> overlong = springs_due(network(), state_.x, state_.v, time(), state_.springs.unloading);
  const double due = due_before(whole_steps(state_), settings().step);
  std::optional<SimulationState> before;  // the first transition
  if (!overlong.empty() || state_.rest.sleepers != sleeping_groups() || have_pins_changed(network().pins, state_.activity, due)) {
    before = state_;
  }
  try {
    if (before) begin_step(overlong, due);
    std::optional<StepReport> report = attempt(PlanReason::first);
    while (!report) {
      if (!before) before = scratch_.begin;
      const BeforeTransition asleep = before_transition();
      state_.activity.asleep = particles_to_sleep();
      make_transition(asleep);
      report = attempt(PlanReason::wake);
    }
    return *report;
  } catch (...) {
    if (before) {
      restore(*before);
    } else if (has_begun_) {
      restore(scratch_.begin);
    }
    throw;
  }
}

/// Springs break, pins begin and end, and groups fall asleep or wake.
void Stepper::begin_step(const std::vector<Index>& overlong, double due) {
  const BeforeTransition now = before_transition();
  const std::vector<Index> broken = breaking_springs(network(), overlong, time(), state_.springs.unloading);
  if (!broken.empty()) {
    const std::vector<char> gone = with_dependents(network().springs, broken);
    for (std::size_t s = 0; s < gone.size(); ++s) {
      if (gone[s] != 0) state_.springs.broken[scratch_.springs_left[s]] = 1;
    }
  }
  state_.activity.asleep = broken.empty() ? particles_to_sleep() : std::vector<char>();
  sprung::change_pins(network().pins, due, state_.activity);
  make_transition(now);
  if (!broken.empty()) wake_all();
}

/// Returns nothing if the step has to be made again because it disturbs sleeping groups; the state is then that at its begin,
/// without these groups in `rest.sleepers`.
std::optional<StepReport> Stepper::attempt(PlanReason reason) {
  if (all_sleep()) {
    const RecordedImpulses impulses_before = state_.impulses;
    count_step(state_);
    add_impulses_of_sleepers(impulses_before);
    record_attachments();
    if (obstacles().moves()) choose_sleepers();
    return StepReport{};
  }
  // Integrators keep the sum of constant forces.
  if (std::exchange(scratch_.conditions_changed, false) && are_constant(work().forces)) resume_integrator(dt());
  scratch_.begin = state_;
  has_begun_ = true;
  const bool any_sleeps = !network().activity.asleep.empty();
  const std::vector<GroupPair> pairs = any_sleeps ? work().surroundings.find(state_).pairs : std::vector<GroupPair>();
  StepPlan plan = work().planner.first(state_, rotation_in_step());
  if (reason == PlanReason::wake) plan.reason = reason;
  std::vector<StepTrial> tried{make_trial(plan)};
  if (disturbs_sleep(pairs)) {
    const std::vector<char> sleepers = state_.rest.sleepers;
    return_to(scratch_.begin);
    state_.rest.sleepers = sleepers;
    return std::nullopt;
  }
  while (const auto next = work().planner.next(tried, scratch_.begin)) {
    if (work().planner.best(tried) + 1 == tried.size()) scratch_.best = state_;
    return_to(scratch_.begin);
    tried.push_back(repeat(*next));
  }
  const std::size_t number = work().planner.best(tried);
  if (number + 1 != tried.size()) return_to(scratch_.best);
  finish_step(tried);
  StepReport report = tried[number].report;
  report.reason = tried[number].plan.reason;
  return report;
}

/// The state is that of the best attempt.
void Stepper::finish_step(std::span<const StepTrial> tried) {
  for (const Index s : let_yield(scratch_.network.springs, state_.x)) {
    state_.springs.rest_lengths[scratch_.springs_left[s]] = network().springs.rest_length[s];
  }
  const double dt_before = dt();
  work().planner.learn(tried, state_);
  substep_changed(dt_before);
  record_attachments();
  const bool breaks = work().attachments && work().attachments->break_overloaded(state_);
  if (breaks) integrator().resume(state_, work().forces, dt());
  add_impulses_of_sleepers(scratch_.begin.impulses);
  choose_sleepers();
  if (breaks) wake_all();
}

/// Continues from a former state of this step.
void Stepper::return_to(const SimulationState& former) {
  state_ = former;
  load();
}

std::string Stepper::caches() const {
  std::string bytes;
  ByteWriter writer(ByteSink{bytes});
  constraints().save(writer);
  return bytes;
}

void Stepper::load_caches(std::string_view bytes) {
  try {
    BinaryReader reader(bytes);
    constraints().load(reader);
    if (reader.remaining() > 0) throw BytesError();
  } catch (const BytesError&) {
    constraints().roll_back(state_.contact.permitted_crossings);
  }
}

void Stepper::load() {
  constraints().roll_back(state_.contact.permitted_crossings);
  step_length_changed();
  if (work().penalty != nullptr) work().penalty->prepare(time());
  if (work().attachments) work().attachments->load(state_, time());
}

StepTrial Stepper::repeat(const StepPlan& plan) {
  try {
    return make_trial(plan);
  } catch (const StepError&) {
    return {.plan = plan, .report = {}, .is_complete = false};
  }
}

/// Throws StepError if it diverges.
StepTrial Stepper::make_trial(const StepPlan& plan) {
  if (plan.trial) {
    state_.limit.handovers[plan.trial->body].solved_since = plan.trial->newton ? std::optional(state_.step) : std::nullopt;
  }
  constraints().follow(plan);
  prepare_step();
  const int planned = state_.substeps;
  set_substeps(plan.substeps());
  StepTrial trial{.plan = plan, .report = {}};
  for (const std::int64_t step = state_.step; state_.step == step && trial.report.max_infeasible < plan.abandon_at;) {
    if (control_.stops && control_.stops()) throw StoppedError();
    trial.report += make_substep(plan.inner);
  }
  note_contacts();
  set_substeps(planned);
  trial.is_complete = trial.report.max_infeasible < plan.abandon_at;
  const auto body = work().planner.body_to_compare(scratch_.begin);
  if (body) trial.body_excess = constraints().limit()->excess(state_.x, network().bodies[*body]);
  return trial;
}

/// Updates attachments and pushes off symmetry, at the begin of each attempt.
void Stepper::prepare_step() {
  update_attachments();
  if (structure().symmetry && constraints().contacts().can_collide() && structure().symmetry->may_push(state_.x)) {
    structure().symmetry->push(contact_normals(), dt(), integrator(), state_);
  }
}

/// An implicit scheme finds the pattern of its matrix anew. Springs that engage at another length than theirs bring energy.
void Stepper::update_attachments() {
  if (!work().attachments || !work().attachments->update(state_)) return;
  integrator().resume(state_, work().forces, dt());
  note_change();
  EnergyWatch::note_pin(work().attachments->winch_speed(state_), state_.energy);
}

/// After each step.
void Stepper::record_attachments() {
  if (!work().attachments || !state_.impulses.on()) return;
  for (const Link& link : state_.links) {
    Vector3& impulse =
        state_.reactions.impulses.try_emplace(network().attachments[link.attachment].name, Vector3::Zero()).first->second;
    impulse += settings().step * work().attachments->force_of(link, state_);
  }
}

/// The largest rotation of an obstacle or a pin [degrees].
double Stepper::rotation_in_step() const {
  const double now = time();
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles().obstacles()) {
    largest = std::max(largest, obstacle.motion.rotation(now, now + settings().step));
  }
  for (std::size_t p = 0; p < network().pins.size(); ++p) {
    const Pin& pin = network().pins[p];
    if (pin.obstacle == kNone && network().activity.phases[p] == PinPhase::holding)
      largest = std::max(largest, pin.motion.rotation(now, now + settings().step));
  }
  return largest;
}

/// The time [s] at the begin of a substep of the present step.
double Stepper::time_of(int substep) const {
  return (static_cast<double>(whole_steps(state_)) + static_cast<double>(substep) / state_.substeps) * settings().step;
}

/// `inner` substeps share their contacts.
StepReport Stepper::make_substep(int inner) {
  const double t = time();
  const double t_end = time_of(state_.substep + 1);
  constraints().begin(state_);
  integrator().advance(state_, work().forces, dt());
  const ObstacleFrame part(obstacles(), t, t_end);
  move_pins(t_end);
  work().energy_watch.note_obstacle(part.max_displacement(state_.x) / dt(), state_.energy);

  StepReport report{.substeps = 1};
  if (inner == 1) {
    constraints().apply(part, part, state_, work().forces, dt(), report);
  } else {
    const int first = state_.substep - state_.substep % inner;
    const ObstacleFrame frame(obstacles(), time_of(first), time_of(first + inner));
    constraints().apply(frame, part, state_, work().forces, dt(), report);
  }
  if (work().attachments) work().attachments->note_substep(dt(), t_end, state_);
  if (++state_.substep == state_.substeps) {
    count_step(state_);
    state_.substep = 0;
  }
  if (work().penalty != nullptr) {
    work().penalty->prepare(t_end);
    record_penalty();
  }
  check_state();
  return report;
}

/// Adds dt times the penalty force at the end of the substep.
void Stepper::record_penalty() {
  if (!state_.impulses.has_contact()) return;
  Points forces = Points::Zero(3, network().particle_count());
  work().penalty->add({.x = state_.x, .v = state_.v, .time = time()}, forces);
  state_.impulses.of_contact += dt() * forces;
}

void Stepper::set_substeps(int substeps) {
  const double dt_before = dt();
  state_.substeps = substeps;
  substep_changed(dt_before);
}

void Stepper::substep_changed(double dt_before) {
  if (dt() == dt_before) return;
  step_length_changed();
  move_pins(time());
  if (is_start()) {
    integrator().start(state_, work().forces, dt());
  } else {
    integrator().step_changed(state_, work().forces, dt_before, dt());
  }
}

void Stepper::move_pins(double time) {
  const Points v_before = state_.impulses.on() ? state_.v : Points();
  EnergyWatch::note_pin(work().pin_paths.move(time, dt(), state_), state_.energy);
  if (!state_.impulses.on()) return;
  for (Index i = 0; i < network().particle_count(); ++i) {
    if (network().is_fixed(i)) record_gain(i, v_before.col(i));
  }
}

/// Records the impulse by which the pin changed the velocity of the particle. Requires that the state records impulses.
void Stepper::record_gain(Index particle, const Vector3& velocity_before) {
  state_.impulses.on_pinned.col(particle) -= network().masses[particle] * (state_.v.col(particle) - velocity_before);
}

void Stepper::step_length_changed() {
  for (const std::unique_ptr<Force>& force : work().forces) force->set_step(dt());
}

std::vector<ContactNormal> Stepper::contact_normals() const {
  return work().penalty != nullptr ? work().penalty->normals(state_.x) : state_.contact.normals;
}

std::vector<Index> Stepper::contacts() const {
  return work().penalty != nullptr ? work().penalty->touching(state_.x) : state_.contact.pushed;
}

/// At the end of a step.
void Stepper::note_contacts() {
  if (work().penalty != nullptr || !constraints().contacts().can_collide()) return;
  std::vector<Index> asleep;
  std::ranges::copy_if(state_.contact.pushed, std::back_inserter(asleep), [&](Index i) { return network().is_asleep(i); });
  state_.contact.pushed.clear();
  std::ranges::merge(constraints().contacts().pushed(), asleep, std::back_inserter(state_.contact.pushed));
  state_.contact.normals = constraints().contacts().normals();
  state_.contact.permitted_crossings = constraints().permitted_crossings();
}

void Stepper::check_state() {
  if (auto failure = structure().divergence.not_finite(state_, constraints().positions_before(state_))) {
    if (control_.adds_any()) {
      failure->remedy = "check the added forces and constraints: one may give nan, or a force may lack append_elements()";
    }
    fail(std::move(*failure));
  }
  const Index check_interval = 1 + network().springs.count() / kSpringsCheckedPerStep;
  if (state_.step % check_interval == 0) {
    if (const auto failure = structure().divergence.overstretched(state_.x)) fail(*failure);
  }
  if (state_.step > 1 && state_.step % (kStepsPerEnergy * check_interval) != 0) return;
  if (control_.adds_any()) return;
  const Energies now = energies();
  if (std::exchange(state_.energy.is_stale, false)) EnergyWatch::note_change(now, state_.energy);
  EnergyWatch::note(state_.step, now, state_.energy);
  check_energy(now);
}

void Stepper::check_energy(const Energies& now) const {
  const auto explosion = work().energy_watch.explosion(now, state_.energy);
  if (!explosion) return;
  StepFailure failure = structure().divergence.fastest(state_);
  failure.cause = *explosion + (failure.cause.empty() ? "" : "; " + failure.cause);
  fail(std::move(failure));
}

Energies Stepper::energies() const {
  return {.kinetic = 0.5 * network().masses.dot(state_.v.colwise().squaredNorm().transpose()),
          .elastic = energy(EnergyKind::elastic),
          .gravity = energy(EnergyKind::gravity),
          .contact = energy(EnergyKind::contact)};
}

void Stepper::fail(StepFailure failure) const {
  failure.step = state_.step;
  failure.time = time();
  set_divergence_remedy(settings(), model_.bounds(), failure);
  throw StepError(std::move(failure));
}

void Stepper::check() const {
  if (const auto failure = structure().divergence.overstretched(state_.x)) fail(*failure);
  if (!control_.adds_any()) check_energy(energies());
}

StepReport& StepReport::operator+=(const StepReport& substep) {
  substeps += substep.substeps;
  iterations += substep.iterations;
  limit_solves += substep.limit_solves;
  stretch_excess = std::max(stretch_excess, substep.stretch_excess);
  truncated += substep.truncated;
  truncation_strain = std::max(truncation_strain, substep.truncation_strain);
  infeasible += substep.infeasible;
  max_infeasible = std::max(max_infeasible, substep.infeasible);
  deformation = substep.deformation;
  return *this;
}

}  // namespace sprung
