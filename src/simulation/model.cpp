#include "simulation/model.h"

#include "network/model/activity.h"
#include "network/model/spring_failure.h"
#include "simulation/settings/settings_check.h"
#include "simulation/step/step_check.h"
#include "simulation/stepper.h"

#include <atomic>
#include <utility>

namespace sprung {
namespace {

std::atomic<std::int64_t> built = 0;

SpringNetwork at_time_0(SpringNetwork network) {
  set_activity(first_activity(network), network);
  return network;
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

std::shared_ptr<const Model> Model::build(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles) {
  std::unique_ptr<Scratch> scratch;
  return build(std::move(network), std::move(settings), std::move(obstacles), scratch);
}

std::shared_ptr<const Model> Model::build(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles,
                                          std::unique_ptr<Scratch>& scratch) {
  const std::shared_ptr<Model> model(
      new Model(std::move(network), std::move(settings), std::make_shared<const ObstacleSet>(std::move(obstacles)), {}));
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
