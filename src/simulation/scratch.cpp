#include "simulation/scratch.h"

#include "dynamics/contact/collision_surface_builder.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/shared_force.h"
#include "network/model/spring_failure.h"
#include "simulation/model/force_factory.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <numeric>

namespace sprung {

Structure::Structure(const SpringNetwork& network, const SimulatorSettings& settings, const ObstacleSet& obstacles)
    : contacts(network, obstacles), groups(network), divergence(network) {
  if (settings.perturb) symmetry.emplace(network, settings.seed);
}

Workspace::Workspace(const SpringNetwork& network, const SimulatorSettings& settings, const SpectralBounds& bounds,
                     const ObstacleSet& obstacles, const Control& control, Structure& structure)
    : forces(
          network_forces(network, settings, splits_dampers(settings, bounds) ? MaterialDampers::apart : MaterialDampers::within)),
      attachments(network.attachments.empty()
                      ? std::optional<Attachments>()
                      : std::optional<Attachments>(std::in_place, network, obstacles, settings.step,
                                                   std::holds_alternative<ImplicitEulerSettings>(settings.integrator))),
      integrator(make_integrator(settings.integrator, network)),
      constraints(network, settings, structure.contacts, *integrator, !obstacles.empty()),
      pin_paths(network, obstacles.obstacles(), settings.step),
      planner(network, settings, constraints.limit(), settings.step > advised_step(settings.integrator, bounds)),
      energy_watch(network, settings, obstacles.obstacles(), forces),
      rest(network, structure.groups, constraints.limit(), settings.gravity),
      surroundings(network, obstacles, structure.groups, settings.step, settings.gravity) {
  if (splits_dampers(settings, bounds)) {
    const double most = most_damping_rate(settings.longest_substep());
    integrator->set_dampers(material_dampers(network, most), std::min(most, bounds.material_damping));
  }
  note_touched(control.touched, structure.groups);
  add_forces(network, settings, obstacles, control);
  constraints.set_steady_acceleration(largest_acceleration(forces));
  add_constraints(network, control);
}

void Workspace::note_touched(const TouchedParticles& touched, const SleepGroups& groups) {
  touches_any = touched.any;
  touched_groups.assign(groups.groups.size(), 0);
  for (const Index i : touched.particles) touched_groups[groups.group_of[i]] = 1;
}

/// Those that network_forces() does not make.
void Workspace::add_forces(const SpringNetwork& network, const SimulatorSettings& settings, const ObstacleSet& obstacles,
                           const Control& control) {
  if (auto air = surface_air(network, settings)) forces.push_back(std::move(air));
  if (auto contact = penalty_contact(network, settings, obstacles)) {
    penalty = contact.get();
    forces.push_back(std::move(contact));
  }
  if (attachments) forces.push_back(std::make_unique<SharedForce>(attachments->springs()));
  for (const std::shared_ptr<Force>& force : control.forces) forces.push_back(std::make_unique<SharedForce>(force));
}

void Workspace::add_constraints(const SpringNetwork& network, const Control& control) {
  for (const std::shared_ptr<Constraint>& constraint : network_constraints(network)) constraints.add(constraint);
  if (attachments && std::ranges::any_of(network.attachments, &Attachment::is_rigid)) constraints.add_rods(attachments->rods());
  for (const std::shared_ptr<Constraint>& constraint : control.constraints) constraints.add(constraint);
}

Scratch::Scratch(const Model& model, const Control& control, const SimulationState& state)
    : settings(model.settings()), obstacles(model.obstacles()) {
  for (std::size_t k = 0; k < control.obstacle_materials.size(); ++k) {
    obstacles.set_material(static_cast<Index>(k), control.obstacle_materials[k]);
  }
  settings.gravity = control.gravity.value_or(settings.gravity);
  settings.wind = control.wind.value_or(settings.wind);
  tear_network(model, state);
  steer(model, state);
  set_activity(state.activity, network);
  rebuild(model, control);
}

void Scratch::rebuild(const Model& model, const Control& control) {
  if (structure) {
    structure->contacts.set_motions(particle_motions(network));
  } else {
    structure.emplace(network, settings, obstacles);
  }
  work.emplace(network, settings, model.bounds(), obstacles, control, *structure);
}

bool Scratch::follow(const Model& model, const Control& control, const SimulationState& state) {
  const bool tears = state.springs.broken != broken_;
  const bool changes = tears || state.activity != network.activity || !work;
  if (changes) work.reset();  // it refers to the network
  if (tears) {
    structure.reset();
    tear_network(model, state);
  }
  if (tears || state.steering != steering_) steer(model, state);
  if (changes) set_activity(state.activity, network);
  copy_rest_lengths(state);
  if (changes) {
    rebuild(model, control);
  } else {
    work->surroundings.note_motions();
  }
  return changes;
}

void Scratch::follow_conditions(const Control& control) {
  settings.gravity = control.gravity.value_or(settings.gravity);
  settings.wind = control.wind.value_or(settings.wind);
  for (const std::unique_ptr<Force>& force : work->forces) force->follow({.gravity = settings.gravity, .wind = settings.wind});
  work->constraints.set_steady_acceleration(largest_acceleration(work->forces));
  conditions_changed = true;
}

/// Pins that a program added, and the motions of pins and obstacles that it moves.
void Scratch::steer(const Model& model, const SimulationState& state) {
  network.pins = model.network().pins;
  network.pins.insert(network.pins.end(), state.steering.added_pins.begin(), state.steering.added_pins.end());
  for (const SteeredMotion& pin : state.steering.pins) network.pins[pin.number].motion = {.poses = pin.poses};
  for (const SteeredMotion& before : steering_.obstacles) {
    if (std::ranges::find(state.steering.obstacles, before.number, &SteeredMotion::number) != state.steering.obstacles.end())
      continue;
    const auto number = static_cast<Index>(before.number);
    obstacles.set_motion(number, model.obstacles().obstacle(number).motion);
  }
  for (const SteeredMotion& obstacle : state.steering.obstacles) {
    obstacles.set_motion(static_cast<Index>(obstacle.number), {.poses = obstacle.poses});
  }
  steering_ = state.steering;
}

void Scratch::tear_network(const Model& model, const SimulationState& state) {
  network = model.network();
  broken_ = state.springs.broken;
  springs_left.clear();
  for (Index s = 0; s < network.springs.count(); ++s) {
    if (!state.springs.is_broken(s)) springs_left.push_back(s);
  }
  tear(network, broken_);
  copy_rest_lengths(state);
}

void Scratch::copy_rest_lengths(const SimulationState& state) {
  if (state.springs.rest_lengths.empty()) return;
  for (std::size_t s = 0; s < springs_left.size(); ++s)
    network.springs.rest_length[s] = state.springs.rest_lengths[springs_left[s]];
}

}  // namespace sprung
