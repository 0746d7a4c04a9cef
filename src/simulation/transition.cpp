// Transitions between two steps: springs, pins, sleepers, the model or the control change, and the state goes on.
#include "dynamics/attachments/engagement.h"
#include "simulation/reaction_record.h"
#include "simulation/settings/settings_check.h"
#include "simulation/start/start_check.h"
#include "simulation/stepper.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

bool is_held(const SpringNetwork& network, const Body& body) {
  return network.inverse_masses.segment(body.first_particle, body.particle_count).isZero(0.0);
}

double excess_of(const StepConstraints& constraints, const Points& positions) {
  return constraints.limit() != nullptr ? constraints.limit()->excess(positions) : 0.0;
}

/// The entries of springs that remain. Both lists of numbers are ascending.
Scalars remaining(const Scalars& of_springs, const std::vector<Index>& before, const std::vector<Index>& after) {
  Scalars left(static_cast<Index>(after.size()));
  std::size_t b = 0;
  for (std::size_t a = 0; a < after.size(); ++a) {
    while (before[b] != after[a]) ++b;
    left[static_cast<Index>(a)] = of_springs[static_cast<Index>(b)];
  }
  return left;
}

}  // namespace

void Stepper::start(std::vector<std::string>& warnings, std::vector<std::string>& notes) {
  state_.rest.sleepers = sleeping_groups();
  if (!constraints().contacts().can_collide()) state_.contact.slip = {};  // each step copies the state
  // The deformation of the first step is not known yet.
  bool moves = !network().velocities.isZero(0.0);
  for (std::size_t p = 0; p < network().pins.size(); ++p) {
    moves = moves || (network().pins[p].moves() && network().activity.phases[p] == PinPhase::holding);
  }
  work().planner.start(moves, state_);
  step_length_changed();
  work().pin_paths.register_pins(state_);
  move_pins(0.0);
  Start found = find_start(network(), obstacles_now(), settings().contact, state_.x);
  state_.x = std::move(found.positions);
  warnings.insert(warnings.end(), found.warnings.begin(), found.warnings.end());
  notes = std::move(found.notes);
  if (constraints().violation(state_.x) > 1.0) correct_positions(dt());
  if (work().attachments) work().attachments->update(state_);
  const std::vector<std::string> of_links = unlikely_lengths(network(), state_.links);
  warnings.insert(warnings.end(), of_links.begin(), of_links.end());
  integrator().start(state_, work().forces, dt());
  note_change();
  if (work().attachments) EnergyWatch::note_pin(work().attachments->winch_speed(state_), state_.energy);
  begin_recording();
}

void Stepper::correct_positions(double dt) {
  constraints().correct_positions(obstacles_now(), state_, dt);
  state_.contact.permitted_crossings = constraints().permitted_crossings();
}

/// Pins set the velocities of their particles before this call, so that these are not recorded as impulses.
void Stepper::begin_recording() {
  if (!settings().record_forces && !settings().record_contact_forces) return;
  const Index n = network().particle_count();
  state_.reactions = {.since = time()};
  state_.impulses.on_pinned.setZero(3, settings().record_forces ? n : 0);
  state_.impulses.of_springs.setZero(settings().record_forces ? network().springs.count() : 0);
  state_.impulses.of_contact.setZero(3, settings().record_contact_forces ? n : 0);
  if (!records_as(settings(), state_.last_impulses)) state_.last_impulses = state_.impulses;
}

BeforeTransition Stepper::before_transition() const {
  BeforeTransition before{.activity = state_.activity,
                          .pins = network().pins,
                          .last_velocities = state_.v,
                          .dt = dt(),
                          .excess = excess_of(constraints(), state_.x),
                          .violation = constraints().violation(state_.x)};
  work().pin_paths.set_last_velocities(time(), dt(), before.last_velocities);
  return before;
}

void Stepper::make_transition(const BeforeTransition& before) {
  const std::vector<Index> springs_before = scratch_.springs_left;
  scratch_.follow(model_, control_, state_);
  if (state_.impulses.on() && scratch_.springs_left.size() != springs_before.size()) {
    for (RecordedImpulses* impulses : {&state_.impulses, &state_.last_impulses}) {
      impulses->of_springs = remaining(impulses->of_springs, springs_before, scratch_.springs_left);
    }
  }
  finish_transition(before, false);
}

void Stepper::adopt(const BeforeTransition& before, const Model& former) {
  note_settings(settings(), state_);
  if (!records_as(settings(), state_.impulses)) {
    state_.impulses = {};
    state_.last_impulses = {};
    begin_recording();
  } else if (state_.impulses.on() && state_.impulses.of_springs.size() != network().springs.count()) {
    state_.impulses.of_springs.setZero(network().springs.count());
    state_.last_impulses.of_springs.setZero(network().springs.count());
  }
  drop_unknown_links(former.network(), network(), state_);
  finish_transition(before, former.settings().integrator.index() != settings().integrator.index());
  note_change();
}

/// `restarts`: the integrator is of another kind.
void Stepper::finish_transition(const BeforeTransition& before, bool restarts) {
  change_sleep(before);
  state_.rest.sleepers = sleeping_groups();
  const bool pins_changed = change_pins(before);
  keep_handovers();
  load();
  const bool limits_more =
      state_.activity.asleep == before.activity.asleep &&
      (excess_of(constraints(), state_.x) > before.excess || constraints().violation(state_.x) > std::max(1.0, before.violation));
  if (limits_more) correct_positions(before.dt);
  if (restarts) {
    integrator().start(state_, work().forces, before.dt);
  } else {
    resume_integrator(before.dt);
  }
  work().planner.note_change(pins_changed, state_);
  substep_changed(before.dt);
  step_length_changed();
}

/// Sets the velocity of particles that fell asleep or woke to 0. A waking group starts a new rest window.
void Stepper::change_sleep(const BeforeTransition& before) {
  for (Index i = 0; i < network().particle_count(); ++i) {
    if (network().is_asleep(i) == before.activity.is_asleep(i)) continue;
    if (!state_.rest.histories.empty() && !network().is_asleep(i)) {
      const Index group = groups().group_of[i];
      state_.rest.histories[group] = {};
      state_.rest.histories[groups().groups.size() + groups().groups[group].body] = {};
    }
    state_.v.col(i).setZero();
    if (!network().is_fixed(i)) integrator().velocity_changed(state_, i, before.dt);
  }
}

/// Starts and ends pins. A particle that becomes free gets its pin's mean velocity over the last step. Returns whether a pin
/// changed.
bool Stepper::change_pins(const BeforeTransition& before) {
  const Points v_before = state_.v;
  bool changed = work().pin_paths.register_pins(state_);
  for (Index i = 0; i < network().particle_count(); ++i) {
    if (state_.activity.is_pinned(i) == before.activity.is_pinned(i)) continue;
    changed = true;
    if (state_.activity.is_pinned(i)) continue;
    state_.v.col(i) = before.last_velocities.col(i);
    if (state_.impulses.on()) record_gain(i, v_before.col(i));
    integrator().velocity_changed(state_, i, before.dt);
  }
  collect_reactions(before.pins, before.activity, state_);
  for (Index i = 0; i < network().particle_count(); ++i) {
    const Index pin = state_.activity.pin_of[i];
    if (pin == kNone || network().pins[pin].moves()) continue;
    state_.v.col(i).setZero();
    if (state_.impulses.on()) record_gain(i, v_before.col(i));
  }
  if (changed) move_pins(time());
  return changed;
}

/// A body stays handed over to a global solve only if the limit may still hand it over.
void Stepper::keep_handovers() {
  for (std::size_t b = 0; b < network().bodies.size(); ++b) {
    if (constraints().limit() != nullptr &&
        (is_held(network(), network().bodies[b]) || constraints().limit()->may_be_handed_over(b))) {
      continue;
    }
    state_.limit.handovers[b] = {};
  }
}

void Stepper::restore(const SimulationState& former) {
  state_ = former;
  scratch_.follow(model_, control_, state_);
  initialize();
}

void Stepper::set_motion(const Points& positions, const Points& velocities) {
  SimulationState changed = state_;
  bool moves = false;
  for (Index i = 0; i < network().particle_count(); ++i) {
    if (network().is_pinned(i)) continue;
    changed.v.col(i) = velocities.col(i);
    integrator().velocity_changed(changed, i, dt());
    if (positions.col(i) == state_.x.col(i)) continue;
    moves = true;
    changed.x.col(i) = positions.col(i);
    changed.x_previous.col(i) += positions.col(i) - state_.x.col(i);
    if (changed.contact.slip.obstacle.empty()) continue;
    changed.contact.slip.displacement.col(i).setZero();
    changed.contact.slip.obstacle[i] = kNone;
  }
  if (moves) {
    changed.contact.pushed.clear();
    changed.contact.normals.clear();
    restore(changed);  // safe regions and pairs are those of the former positions
  } else {
    state_ = changed;
    if (is_start()) resume_integrator(dt());
  }
  wake_all();
  note_change();
}

void Stepper::initialize() {
  work().pin_paths.register_pins(state_);
  load();
  resume_integrator(dt());
}

void Stepper::follow_conditions() {
  scratch_.follow_conditions(control_);
  state_.energy.is_stale = true;
  if (is_start()) resume_integrator(dt());
  wake_all();
}

/// At time 0 the forces determine Verlet's positions one step ago.
void Stepper::resume_integrator(double dt) {
  if (is_start()) {
    integrator().start(state_, work().forces, dt);
  } else {
    integrator().resume(state_, work().forces, dt);
  }
}

}  // namespace sprung
