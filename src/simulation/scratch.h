// The memory in which steps work. Internal to simulation/.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/attachments/attachments.h"
#include "dynamics/contact/contact_force.h"
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

/// Objects that depend on the unbroken springs alone, not on pins or sleep.
struct Structure {
  Structure(const SpringNetwork& network, const SimulatorSettings& settings, const ObstacleSet& obstacles);

  ContactProjection contacts;
  SleepGroups groups;
  DivergenceCheck divergence;
  std::optional<SymmetryBreaker> symmetry;  ///< none unless the settings ask for it
};

/// The other objects that make a step.
struct Workspace {
  /// Keeps references to the network, the settings, the obstacles and the structure. The bounds are those of the model.
  Workspace(const SpringNetwork& network, const SimulatorSettings& settings, const SpectralBounds& bounds,
            const ObstacleSet& obstacles, const Control& control, Structure& structure);

  void note_touched(const TouchedParticles& touched, const SleepGroups& groups);

  Forces forces;
  ContactForce* penalty = nullptr;         ///< null unless contact is by penalty
  std::optional<Attachments> attachments;  ///< none without attachments in the network
  std::unique_ptr<Integrator> integrator;
  StepConstraints constraints;
  PinPaths pin_paths;
  StepPlanner planner;
  EnergyWatch energy_watch;
  RestDetector rest;
  Surroundings surroundings;
  std::vector<char> touched_groups;  ///< whether an added force or constraint touches each sleep group
  bool touches_any = false;          ///< whether an added force or constraint may touch any particle

 private:
  void add_forces(const SpringNetwork& network, const SimulatorSettings& settings, const ObstacleSet& obstacles,
                  const Control& control);
  void add_constraints(const SpringNetwork& network, const Control& control);
};

/// Model data as the state and the control change them, and caches. Can be rebuilt from the three.
struct Scratch {
  /// For the state.
  Scratch(const Model& model, const Control& control, const SimulationState& state);
  Scratch(const Scratch&) = delete;

  /// Follows the springs, the activity and the steering of the state. If springs or the activity changed, the workspace is a new
  /// one, without memory. Returns whether it is. Calls no code of the program's forces and constraints: they could throw. If memory
  /// runs out, there is no workspace until the scratch follows a state again.
  bool follow(const Model& model, const Control& control, const SimulationState& state);

  /// Sets gravity and wind. Takes one pass over particles and faces if there is air, else constant time.
  void follow_conditions(const Control& control);

  SpringNetwork network;            ///< of the present
  SimulatorSettings settings;       ///< of the present
  ObstacleSet obstacles;            ///< of the present
  bool conditions_changed = false;  ///< since the last step
  std::vector<Index> springs_left;  ///< the numbers in the model of its springs, ascending
  std::optional<Structure> structure;
  std::optional<Workspace> work;  ///< like the structure, none only while it is made, and after it could not be made
  SimulationState begin;          ///< of the step
  SimulationState best;           ///< the end of its best attempt, while others are made

 private:
  void tear_network(const Model& model, const SimulationState& state);
  void copy_rest_lengths(const SimulationState& state);
  void steer(const Model& model, const SimulationState& state);
  void rebuild(const Model& model, const Control& control);

  std::vector<char> broken_;  ///< springs of the model that `network` lacks
  Steering steering_;         ///< of which the network and the obstacles have the motions
};

}  // namespace sprung
