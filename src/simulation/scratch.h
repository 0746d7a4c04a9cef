// The memory in which steps work. Internal to simulation/.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/attachments/attachments.h"
#include "dynamics/contact/penalty_contact.h"
#include "dynamics/forces/surface_air_force.h"
#include "dynamics/integrators/integrator.h"
#include "simulation/control.h"
#include "simulation/model.h"
#include "simulation/monitoring/divergence.h"
#include "simulation/monitoring/energy_watch.h"
#include "simulation/sleep/rest_detector.h"
#include "simulation/sleep/sleep_group.h"
#include "simulation/sleep/surroundings.h"
#include "simulation/step/pin_paths.h"
#include "simulation/step/step_constraints.h"
#include "simulation/step/step_planner.h"
#include "simulation/step/symmetry_breaker.h"

#include <memory>
#include <optional>
#include <vector>

namespace sprung {

/// The objects that make a step. All follow from the present network, the settings, the obstacles and the control.
struct Workspace {
  /// Keeps references to the network, the obstacles and the settings of the model.
  Workspace(const Model& model, const SpringNetwork& network, const ObstacleSet& obstacles, const Control& control);

  Forces forces;
  SurfaceAirForce* surface_air = nullptr;  ///< null unless the air acts on faces
  PenaltyContact* penalty = nullptr;       ///< null unless contact is by penalty
  std::optional<Attachments> attachments;  ///< none without attachments in the network
  std::unique_ptr<Integrator> integrator;
  StepConstraints constraints;
  PinPaths pin_paths;
  std::optional<SymmetryBreaker> symmetry;  ///< none unless the settings ask for it
  StepPlanner planner;
  DivergenceCheck divergence;
  EnergyWatch energy_watch;
  SleepGroups groups;
  RestDetector rest;
  Surroundings surroundings;

 private:
  void add_forces(const Model& model, const SpringNetwork& network, const ObstacleSet& obstacles, const Control& control);
  void add_constraints(const SpringNetwork& network, const Control& control);
};

/// What a state and the control make of the model, and memory of former steps. Whoever loses it can build it again.
struct Scratch {
  /// For the state.
  Scratch(const Model& model, const Control& control, const SimulationState& state);
  Scratch(const Scratch&) = delete;

  /// Follows the springs and the activity of the state. If they changed, the workspace is a new one, without memory. Returns
  /// whether it is.
  bool follow(const Model& model, const Control& control, const SimulationState& state);

  /// Makes the workspace anew.
  void rebuild(const Model& model, const Control& control);

  SpringNetwork network;            ///< of the present
  ObstacleSet obstacles;            ///< of the present
  std::vector<Index> springs_left;  ///< the numbers in the model of its springs, ascending
  std::optional<Workspace> work;    ///< none only while it is made
  SimulationState begin;            ///< of the step
  SimulationState best;             ///< the end of its best attempt, while others are made

 private:
  void tear_network(const Model& model, const SimulationState& state);
  void copy_rest_lengths(const SimulationState& state);

  std::vector<char> broken_;  ///< springs of the model that `network` lacks
};

/// The step as SurfaceAirForce takes it.
[[nodiscard]] inline double air_step(const SimulatorSettings& settings, double dt) {
  return std::holds_alternative<ImplicitEulerSettings>(settings.integrator) ? 0.0 : dt;
}

}  // namespace sprung
