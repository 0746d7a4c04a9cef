#include "simulation/scratch.h"

#include "dynamics/constraints/carried_surface.h"
#include "dynamics/constraints/cell_volume.h"
#include "dynamics/constraints/enclosed_volume.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/shared_force.h"
#include "network/model/spring_failure.h"
#include "simulation/model/network_forces.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <numeric>

namespace sprung {

Workspace::Workspace(const Model& model, const SpringNetwork& network, const ObstacleSet& obstacles, const Control& control)
    : forces(network_forces(network, model.settings(),
                            splits_dampers(model.settings(), model.bounds()) ? MaterialDampers::apart : MaterialDampers::within)),
      integrator(make_integrator(model.settings().integrator, network)),
      constraints(network, model.settings(), steady_acceleration(network, model.settings()), obstacles, *integrator),
      pin_paths(network, obstacles.obstacles(), model.settings().step),
      planner(network, model.settings(), constraints.limit()),
      divergence(network),
      energy_watch(network, model.settings(), obstacles.obstacles(), forces),
      groups(network),
      rest(network, groups, constraints.limit(), model.settings().gravity.norm()),
      surroundings(network, obstacles, groups, model.settings().step, model.settings().gravity.norm()) {
  const SimulatorSettings& settings = model.settings();
  if (settings.perturb) symmetry.emplace(network, settings.seed);
  if (!network.attachments.empty()) {
    const bool implicit = std::holds_alternative<ImplicitEulerSettings>(settings.integrator);
    attachments.emplace(network, obstacles, settings.step, implicit);
  }
  if (splits_dampers(settings, model.bounds())) {
    const double most = most_damping_rate(settings.step);
    integrator->set_dampers(material_dampers(network, most), std::min(most, model.bounds().material_damping));
  }
  add_forces(model, network, obstacles, control);
  add_constraints(network, control);
}

/// Those that network_forces() does not make.
void Workspace::add_forces(const Model& model, const SpringNetwork& network, const ObstacleSet& obstacles, const Control& control) {
  const SimulatorSettings& settings = model.settings();
  if (acts_on_faces(network, settings)) {
    auto force = std::make_unique<SurfaceAirForce>(network, settings.air_surface, settings.wind, settings.gravity.norm(),
                                                   air_step(settings, settings.step));
    surface_air = force.get();
    forces.push_back(std::move(force));
  }
  if (settings.contact.response == ContactSettings::Response::penalty && !obstacles.empty()) {
    auto force =
        std::make_unique<PenaltyContact>(network, obstacles, settings.contact.stiffness, settings.contact.damping, settings.step);
    penalty = force.get();
    forces.push_back(std::move(force));
  }
  if (attachments) forces.push_back(std::make_unique<SharedForce>(attachments->springs()));
  for (const std::shared_ptr<Force>& force : control.forces) forces.push_back(std::make_unique<SharedForce>(force));
}

void Workspace::add_constraints(const SpringNetwork& network, const Control& control) {
  if (std::ranges::any_of(network.bodies, [](const Body& body) { return !body.carried.empty(); })) {
    constraints.add(std::make_unique<CarriedSurface>(network));
  }
  if (std::ranges::any_of(network.bodies, &Body::preserve_volume)) constraints.add(std::make_unique<CellVolume>(network));
  if (std::ranges::any_of(network.bodies, [](const Body& body) { return body.volume_factor != 0.0; })) {
    constraints.add(std::make_unique<EnclosedVolume>(network));
  }
  if (attachments && std::ranges::any_of(network.attachments, &Attachment::is_rigid)) constraints.add_rods(attachments->rods());
  for (const std::shared_ptr<Constraint>& constraint : control.constraints) constraints.add(constraint);
}

Scratch::Scratch(const Model& model, const Control& control, const SimulationState& state) : obstacles(model.obstacles()) {
  for (std::size_t k = 0; k < control.obstacle_materials.size(); ++k) {
    obstacles.set_material(static_cast<Index>(k), control.obstacle_materials[k]);
  }
  tear_network(model, state);
  set_activity(state.activity, network);
  rebuild(model, control);
}

void Scratch::rebuild(const Model& model, const Control& control) {
  work.reset();
  work.emplace(model, network, obstacles, control);
}

bool Scratch::follow(const Model& model, const Control& control, const SimulationState& state) {
  const bool tears = state.springs.broken != broken_;
  const bool changes = tears || state.activity != network.activity || !work;
  if (changes) work.reset();  // it refers to the network
  if (tears) tear_network(model, state);
  if (changes) set_activity(state.activity, network);
  copy_rest_lengths(state);
  if (changes) rebuild(model, control);
  return changes;
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
