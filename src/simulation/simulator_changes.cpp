#include "base/error.h"
#include "base/format.h"
#include "base/problem_list.h"
#include "dynamics/attachments/engagement.h"
#include "network/model/pin_schedule.h"
#include "network/model/sleeping_particles.h"
#include "network/model/spring_failure.h"
#include "simulation/simulator_implementation.h"
#include "simulation/state_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sprung {
namespace {

bool have_same_bodies(const SpringNetwork& a, const SpringNetwork& b) {
  return std::ranges::equal(a.bodies, b.bodies, [](const Body& first, const Body& second) {
    return first.name == second.name && first.first_particle == second.first_particle &&
           first.particle_count == second.particle_count;
  });
}

bool is_held(const SpringNetwork& network, const Body& body) {
  return network.inverse_masses.segment(body.first_particle, body.particle_count).isZero(0.0);
}

bool collide_alike(const SpringNetwork& a, const SpringNetwork& b) {
  return std::ranges::equal(a.bodies, b.bodies, [](const Body& first, const Body& second) {
    return first.contact.self == second.contact.self && first.contact.others == second.contact.others;
  });
}

// Time is counted in frames, and within a frame in steps.
void check_step_change(const SimulatorSettings& settings, const SimulatorSettings& before, const SimulationState& state,
                       ProblemList& problems) {
  if (settings.step == before.step && settings.steps_per_frame == before.steps_per_frame) return;
  const double frame = before.step * before.steps_per_frame;
  constexpr double kRounding = 1.0e-9;
  if (std::abs(settings.step * settings.steps_per_frame - frame) > kRounding * frame) {
    problems.add("step", format_number(settings.step, 6),
                 "times steps_per_frame must stay a frame of " + format_number(frame, 6) + " s, as the run goes on",
                 "change both, or begin a new run");
  } else if (state.step_in_frame != 0) {
    problems.add("step", format_number(settings.step, 6), "may change at the end of a frame alone, as the run goes on",
                 "make the other steps of the frame first");
  }
}

// The cached contacts and permitted crossings of a run belong to its elements.
void check_change(const SpringNetwork& network, const SimulatorSettings& settings, const SpringNetwork& network_before,
                  const SimulatorSettings& settings_before, const SimulationState& state) {
  const std::string restart = "begin a new run";
  ProblemList problems;
  if (!have_same_bodies(network, network_before)) {
    problems.add("bodies", "", "must have the same names and particles as before, as the run goes on", restart);
  } else if (!collide_alike(network, network_before)) {
    problems.add("contact", "", "must be asked for between the same bodies as before, as the run goes on", restart);
  }
  if (network.broken.count() > network_before.broken.count()) {
    problems.add("springs", "", "must not lack springs that did not break in this run", restart);
  }
  check_step_change(settings, settings_before, state, problems);
  if (settings.contact.response != settings_before.contact.response) {
    problems.add("contact.response", "", "must stay as it is, as the run goes on", restart);
  }
  problems.throw_if_any();
}

SpringNetwork with_pins_of(SpringNetwork network, std::int64_t step, double step_length) {
  change_pins(network, due_before(step, step_length));
  return network;
}

/// Settings for a step that was accepted: its bound is an estimate, which varies with the network.
SimulatorSettings accepted(SimulatorSettings settings) {
  settings.stability = StabilityCheck::warn;
  return settings;
}

double excess_of(const StepConstraints& constraints, const Points& positions) {
  return constraints.limit() != nullptr ? constraints.limit()->excess(positions) : 0.0;
}

void check_entry(const std::string& key, std::size_t number, std::size_t count) {
  if (number < count) return;
  throw InputError(
      {.key = key, .value = std::to_string(number), .rule = "there are only " + std::to_string(count), .remedy = "count from 0"});
}

void check_number(const std::string& key, double number, ProblemList& problems) {
  if (std::isfinite(number) && number >= 0.0) return;
  problems.add(key, format_number(number, 6), "must be finite and not negative", "");
}

}  // namespace

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, External added,
                                          const Implementation& before)
    : Implementation(with_pins_of(std::move(model), whole_steps(before.state), before.settings.step), std::move(chosen),
                     before.shared_obstacles, std::move(added)) {
  inherit_state(before);
}

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> given,
                                          const SimulationState& former)
    : Implementation(std::move(model), accepted(std::move(chosen)), std::make_shared<ObstacleSet>(std::move(given)), {}) {
  check_resumed_state({.network = network,
                       .settings = settings,
                       .obstacles = obstacles.obstacles(),
                       .sleep_groups = groups.count(),
                       .can_collide = constraints.contacts().can_collide()},
                      former);
  return_to(former);
  keep_handovers();
  pin_paths.register_pins(state);
  integrator->resume(state, forces, dt());
  const double dt_before = dt();
  planner.note_change(false, state);
  substep_changed(dt_before);
  if (!settings.record_forces || !state.last_impulses.on()) state.impulses = state.last_impulses = {};
  begin_recording();
}

/// Lets pins begin and end. A particle that becomes free gets its pin's mean velocity over the last `dt`. Returns whether a pin
/// changed.
bool Simulator::Implementation::inherit_pins(const Implementation& before) {
  const Points v_before = state.v;
  Points last_velocities = state.v;
  before.pin_paths.set_last_velocities(time(), before.dt(), last_velocities);
  bool changed = pin_paths.register_pins(state);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_asleep(i) != before.network.is_asleep(i)) continue;
    if (network.is_pinned(i) == before.network.is_pinned(i)) continue;
    changed = true;
    if (network.is_pinned(i)) continue;
    state.v.col(i) = last_velocities.col(i);
    if (state.impulses.on()) record_gain(i, v_before.col(i));
    integrator->velocity_changed(state, i, before.dt());
  }
  reactions.collect(before.network.pins, state.impulses);
  for (const Pin& pin : network.pins) {
    if (pin.moves()) continue;
    for (const Index i : pin.particles) {
      state.v.col(i).setZero();
      if (state.impulses.on()) record_gain(i, v_before.col(i));
    }
  }
  if (changed) move_pins(time());
  return changed;
}

/// A body stays handed over to a global solve only if the limit may still hand it over.
void Simulator::Implementation::keep_handovers() {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    if (constraints.limit() != nullptr && (is_held(network, network.bodies[b]) || constraints.limit()->may_be_handed_over(b))) {
      continue;
    }
    state.limit.handovers[b] = {};
  }
}

void Simulator::Implementation::inherit_state(const Implementation& before) {
  stops = before.stops;
  state = before.state;
  state.steps_per_frame = settings.steps_per_frame;
  reactions = before.reactions;
  forces_since = before.forces_since;
  if (settings.record_forces != state.impulses.on()) {
    state.impulses = {};
    state.last_impulses = {};
    begin_recording();
  } else if (state.impulses.on() && state.impulses.of_springs.size() != network.springs.count()) {
    state.impulses.of_springs.setZero(network.springs.count());
    state.last_impulses.of_springs.setZero(network.springs.count());
  }
  inherit_sleep(before);
  state.rest.sleepers = sleeping_groups();
  const bool pins_changed = inherit_pins(before);
  keep_handovers();
  constraints.roll_back(state.contact.permitted_crossings);
  if (penalty != nullptr) penalty->prepare(time());
  drop_unknown_links(before.network, network, state);
  if (attachments) attachments->load(state, time());
  const bool limits_more = network.asleep == before.network.asleep &&
                           (excess_of(constraints, state.x) > excess_of(before.constraints, state.x) ||
                            constraints.violation(state.x) > std::max(1.0, before.constraints.violation(state.x)));
  if (limits_more) correct_positions(before.dt());
  if (before.settings.integrator.index() == settings.integrator.index()) {
    integrator->resume(state, forces, before.dt());
  } else {
    integrator->start(state, forces, before.dt());
  }
  planner.note_change(pins_changed, state);
  substep_changed(before.dt());
  step_length_changed();
}

/// Continues with a network that lost springs, and with other pins and sleepers. `springs_left` are the springs of the
/// present network that remain in it, ascending. Returns the former simulator.
std::unique_ptr<Simulator::Implementation> Simulator::rebuild(SpringNetwork network, const std::vector<Index>& springs_left) {
  const Implementation& now = *implementation_;
  auto next = std::make_unique<Implementation>(std::move(network), accepted(now.settings), now.external, now);
  next->settings.stability = now.settings.stability;
  if (now.state.impulses.on()) {
    next->state.impulses.of_springs = now.state.impulses.of_springs(springs_left);
    next->state.last_impulses.of_springs = now.state.last_impulses.of_springs(springs_left);
  }
  next->warnings = now.warnings;  // with those of the start
  next->notes = now.notes;
  return std::exchange(implementation_, std::move(next));
}

/// Continues with other sleepers, by particle; empty: none.
std::unique_ptr<Simulator::Implementation> Simulator::rebuild(std::vector<char> asleep) {
  SpringNetwork network = implementation_->network;
  set_asleep(std::move(asleep), network);
  std::vector<Index> all_springs(static_cast<std::size_t>(network.springs.count()));
  std::iota(all_springs.begin(), all_springs.end(), 0);
  return rebuild(std::move(network), all_springs);
}

Simulator Simulator::resume(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> given,
                            const SimulationState& state) {
  const StabilityCheck stability = settings.stability;
  auto resumed = std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(given), state);
  resumed->settings.stability = stability;
  return Simulator(std::move(resumed));
}

void Simulator::wake() {
  implementation_->wake_all();
  if (!network().asleep.empty()) rebuild(std::vector<char>());
}

/// Wakes all particles and continues with what `make` returns. If it throws, nothing has changed.
void Simulator::change_awake(const std::function<std::unique_ptr<Implementation>(const Implementation& now)>& make) {
  const RestMemory rest = state().rest;
  std::unique_ptr<Implementation> asleep;
  try {
    implementation_->wake_all();
    if (!network().asleep.empty()) asleep = rebuild(std::vector<char>());
    implementation_ = make(*implementation_);
  } catch (...) {
    if (asleep) implementation_ = std::move(asleep);
    implementation_->state.rest = rest;
    throw;
  }
  implementation_->note_change();
}

void Simulator::continue_with(SpringNetwork network, SimulatorSettings settings) {
  check_change(network, settings, implementation_->network, implementation_->settings, implementation_->state);
  change_awake([&](const Implementation& now) {
    if (network.broken.count() < now.network.broken.count()) tear_as(now.network, network);
    copy_rest_lengths(now.network, network);
    return std::make_unique<Implementation>(awake(std::move(network)), std::move(settings), now.external, now);
  });
}

void Simulator::set_gravity(const Vector3& acceleration) {
  SimulatorSettings settings = implementation_->settings;
  settings.gravity = acceleration;
  continue_with(implementation_->network, std::move(settings));
}

void Simulator::set_air(double drag, const Wind& wind) {
  SimulatorSettings settings = implementation_->settings;
  settings.air_drag = drag;
  settings.wind = wind;
  continue_with(implementation_->network, std::move(settings));
}

void Simulator::set_stretch_limit(const std::optional<StretchLimitSettings>& limit) {
  SimulatorSettings settings = implementation_->settings;
  settings.stretch_limit = limit;
  continue_with(implementation_->network, std::move(settings));
}

void Simulator::set_springs(std::size_t body, SpringKind kind, double stiffness, double damping) {
  SpringNetwork network = implementation_->network;
  check_entry("bodies", body, network.bodies.size());
  const Body& changed = network.bodies[body];
  const std::string key = "bodies." + changed.name + ".springs." + kSpringKindNames[static_cast<std::size_t>(kind)];
  ProblemList problems;
  check_number(key + ".stiffness", stiffness, problems);
  check_number(key + ".damping", damping, problems);
  problems.throw_if_any();
  Springs& springs = network.springs;
  for (Index s = changed.first_spring; s < changed.first_spring + changed.spring_count; ++s) {
    if (springs.kind[s] != kind) continue;
    springs.stiffness[s] = stiffness;
    springs.damping[s] = damping;
  }
  continue_with(std::move(network), implementation_->settings);
}

void Simulator::set_body_material(std::size_t body, const ContactMaterial& material) {
  SpringNetwork network = implementation_->network;
  check_entry("bodies", body, network.bodies.size());
  Body& changed = network.bodies[body];
  ProblemList problems;
  check_material("bodies." + changed.name, material, problems);
  problems.throw_if_any();
  changed.material = material;
  continue_with(std::move(network), implementation_->settings);
}

void Simulator::set_obstacle_material(std::size_t obstacle, const ContactMaterial& material) {
  ObstacleSet& obstacles = implementation_->obstacles;
  check_entry("obstacles", obstacle, obstacles.obstacles().size());
  ProblemList problems;
  check_material("obstacles." + obstacles.obstacles()[obstacle].name, material, problems);
  problems.throw_if_any();
  obstacles.set_material(static_cast<Index>(obstacle), material);
  continue_with(implementation_->network, implementation_->settings);
}

void Simulator::pin(Index particle) {
  SpringNetwork network = awake(implementation_->network);
  if (network.is_pinned(particle)) return;
  const Body& body = network.body_of(particle);
  const std::string name = body.name + ".particles[" + std::to_string(particle - body.first_particle) + "]";
  if (std::ranges::find(network.pin_names, name) == network.pin_names.end()) network.pin_names.push_back(name);
  Pin& pin = network.pins.emplace_back();
  pin.particles = {particle};
  pin.name = name;
  network.inverse_masses[particle] = 0.0;
  continue_with(std::move(network), implementation_->settings);
}

void Simulator::release(Index particle) {
  SpringNetwork network = awake(implementation_->network);
  if (!network.is_pinned(particle)) return;
  for (Pin& pin : network.pins) std::erase(pin.particles, particle);
  std::erase_if(network.pins, [](const Pin& pin) { return pin.particles.empty(); });
  network.inverse_masses[particle] = 1.0 / network.masses[particle];
  continue_with(std::move(network), implementation_->settings);
}

void Simulator::add_force(std::shared_ptr<Force> force) {
  External external = implementation_->external;
  external.forces.push_back(std::move(force));
  continue_with_external(std::move(external));
}

void Simulator::remove_force(const Force& force) {
  External external = implementation_->external;
  const auto is_it = [&](const std::shared_ptr<Force>& added) { return added.get() == &force; };
  if (std::erase_if(external.forces, is_it) > 0) continue_with_external(std::move(external));
}

void Simulator::add_constraint(std::shared_ptr<Constraint> constraint) {
  External external = implementation_->external;
  external.constraints.push_back(std::move(constraint));
  continue_with_external(std::move(external));
}

void Simulator::remove_constraint(const Constraint& constraint) {
  External external = implementation_->external;
  const auto is_it = [&](const std::shared_ptr<Constraint>& added) { return added.get() == &constraint; };
  if (std::erase_if(external.constraints, is_it) > 0) continue_with_external(std::move(external));
}

void Simulator::continue_with_external(External external) {
  change_awake([&](const Implementation& now) {
    return std::make_unique<Implementation>(now.network, now.settings, std::move(external), now);
  });
}

}  // namespace sprung
