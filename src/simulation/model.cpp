#include "simulation/model.h"

#include "base/error.h"
#include "network/model/activity.h"
#include "network/model/spring_failure.h"
#include "simulation/settings/settings_check.h"
#include "simulation/step/step_check.h"
#include "simulation/stepper.h"

#include <atomic>
#include <string>
#include <utility>

namespace sprung {
namespace {

std::atomic<std::int64_t> built = 0;

SpringNetwork at_time_0(SpringNetwork network) {
  set_activity(first_activity(network), network);
  return network;
}

/// The entries of the start must be those of the network, or empty.
template <class List>
void replace(const List& of_start, List& list, const char* name) {
  if (of_start.size() == 0) return;
  if (of_start.size() != list.size()) {
    throw InputError({"", std::string("start.") + name, std::to_string(of_start.size()) + " entries",
                      "must have " + std::to_string(list.size()), "give the end of a simulation of the same network"});
  }
  list = of_start;
}

void begin_as(const StartState& start, const SpringNetwork& network, SimulationState& state) {
  if (start.positions.size() == 0) return;
  replace(start.positions, state.x, "positions");
  replace(start.velocities, state.v, "velocities");
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_pinned(i)) state.v.col(i).setZero();
  }
  state.x_previous = state.x;
  replace(start.rest_lengths, state.springs.rest_lengths, "rest_lengths");
  replace(start.broken, state.springs.broken, "broken");
  replace(start.slip.displacement, state.contact.slip.displacement, "slip.displacement");
  replace(start.slip.obstacle, state.contact.slip.obstacle, "slip.obstacle");
  // Pins move their particles from where these are now, not from where they are at rest.
  for (Index i = 0; i < network.particle_count(); ++i) {
    const Index pin = state.activity.pin_of[i];
    if (pin == kNone || !network.pins[static_cast<std::size_t>(pin)].moves()) continue;
    state.grips.push_back({.particle = i, .from = network.pins[static_cast<std::size_t>(pin)].from, .position = state.x.col(i)});
  }
}

}  // namespace

Model::Model(SpringNetwork network, SimulatorSettings settings, std::shared_ptr<const ObstacleSet> obstacles,
             const std::vector<std::shared_ptr<Force>>& forces)
    : network_(at_time_0(std::move(network))),
      settings_(checked_settings(std::move(settings))),
      obstacles_(std::move(obstacles)),
      bounds_(simulation_bounds(network_, settings_, !obstacles_->empty(), forces)),
      warnings_(check_step(settings_, bounds_)),
      initial_state_(sprung::initial_state(network_)) {
  ++built;
  note_settings(settings_, initial_state_);
  for (const auto& more : {unused_settings(settings_, network_, obstacles_->obstacles()), weak_springs(settings_, network_)}) {
    warnings_.insert(warnings_.end(), more.begin(), more.end());
  }
}

void note_settings(const SimulatorSettings& settings, SimulationState& state) {
  state.steps_per_frame = settings.steps_per_frame;
  state.step_length = settings.step;
  state.integrator = settings.integrator.index();
}

BuildCounts Model::build_counts() { return {.models = built, .bounds = bounds_count()}; }

std::shared_ptr<const Model> Model::build(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles,
                                          const StartState& start) {
  std::unique_ptr<Scratch> scratch;
  return build(std::move(network), std::move(settings), std::move(obstacles), start, scratch);
}

std::shared_ptr<const Model> Model::build(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles,
                                          const StartState& start, std::unique_ptr<Scratch>& scratch) {
  const std::shared_ptr<Model> model(
      new Model(std::move(network), std::move(settings), std::make_shared<const ObstacleSet>(std::move(obstacles)), {}));
  begin_as(start, model->network_, model->initial_state_);
  const Control none;
  scratch = std::make_unique<Scratch>(*model, none, model->initial_state_);
  Stepper(*model, none, model->initial_state_, *scratch).start(model->warnings_, model->notes_);
  return model;
}

std::shared_ptr<const Model> Model::changed(const Model& before, SpringNetwork network, SimulatorSettings settings,
                                            const std::vector<std::shared_ptr<Force>>& forces) {
  const std::shared_ptr<Model> model(new Model(std::move(network), std::move(settings), before.obstacles_, forces));
  SimulationState start = before.initial_state_;
  start.springs = model->initial_state_.springs;
  start.activity = model->initial_state_.activity;
  note_settings(model->settings_, start);
  model->initial_state_ = std::move(start);
  return model;
}

}  // namespace sprung
