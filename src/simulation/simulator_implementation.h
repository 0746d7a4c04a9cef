// The members of the simulator. Internal to simulation/.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/attachments/attachments.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/contact/penalty_contact.h"
#include "dynamics/forces/force.h"
#include "dynamics/forces/surface_air_force.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/integrators/spectral_bounds.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"
#include "simulation/monitoring/divergence.h"
#include "simulation/monitoring/energy_watch.h"
#include "simulation/reaction_record.h"
#include "simulation/simulator.h"
#include "simulation/sleep/rest_detector.h"
#include "simulation/sleep/sleep_group.h"
#include "simulation/sleep/surroundings.h"
#include "simulation/step/pin_paths.h"
#include "simulation/step/step_constraints.h"
#include "simulation/step/step_planner.h"
#include "simulation/step/symmetry_breaker.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sprung {

struct Simulator::External {
  std::vector<std::shared_ptr<Force>> forces;
  Constraints constraints;
  [[nodiscard]] bool empty() const { return forces.empty() && constraints.empty(); }
};

struct Simulator::Implementation {
  /// At time 0.
  Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> given);
  /// In the state of another simulator of the same particles and obstacles.
  Implementation(SpringNetwork model, SimulatorSettings chosen, External added, const Implementation& before);
  /// Continues from a state of the same network.
  Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> given, const SimulationState& former);
  /// Without a state.
  Implementation(SpringNetwork model, SimulatorSettings chosen, std::shared_ptr<ObstacleSet> shared, External added);

  void add_forces();
  void add_constraints();
  void inherit_state(const Implementation& before);
  void keep_handovers();
  [[nodiscard]] bool anything_moves() const;
  /// Makes a step. Returns nothing if it has to be made again because it disturbs sleeping groups; the state is then that at the
  /// begin of the step, without these groups in `rest.sleepers`. If it throws, the state is that at the begin of the step.
  std::optional<StepReport> step(PlanReason reason);
  std::optional<StepReport> step_from_begin(PlanReason reason);
  StepTrial make_trial(const StepPlan& plan);
  StepTrial repeat(const StepPlan& plan);
  void finish_step(std::span<const StepTrial> tried);
  void return_to(const SimulationState& former);
  void prepare_step();
  [[nodiscard]] double rotation_in_step() const;
  StepReport make_substep();
  void set_substeps(int substeps);
  void substep_changed(double dt_before);
  void step_length_changed();
  [[nodiscard]] bool may_sleep() const;
  [[nodiscard]] bool sleeps(Index group) const;
  [[nodiscard]] bool is_free(Index group) const;
  [[nodiscard]] std::vector<char> sleeping_groups() const;
  [[nodiscard]] std::vector<char> particles_to_sleep() const;
  void choose_sleepers();
  void wake_all();
  void add_sleepers(const std::vector<GroupPair>& pairs, const std::vector<char>& disturbed);
  [[nodiscard]] std::vector<Index> steady_groups(const std::vector<char>& bodies) const;
  void wake_with_bodies(const std::vector<char>& asleep);
  [[nodiscard]] bool disturbs_sleep(const std::vector<GroupPair>& pairs);
  [[nodiscard]] bool all_sleep() const;
  void add_impulses_of_sleepers(const RecordedImpulses& before);
  void inherit_sleep(const Implementation& before);
  [[nodiscard]] double air_step() const;
  void move_pins(double time);
  void record_gain(Index particle, const Vector3& velocity_before);
  void correct_positions(double dt);
  void begin_recording();
  void note_change() { EnergyWatch::note_change(energies(), state.energy); }
  bool inherit_pins(const Implementation& before);
  void update_attachments();
  void record_attachments();
  [[nodiscard]] double energy(EnergyKind kind) const { return energy_of(forces, kind, state.x); }
  [[nodiscard]] Energies energies() const;
  [[nodiscard]] std::vector<ContactNormal> contact_normals() const;
  [[nodiscard]] std::vector<Index> contacts() const;
  void note_contacts();
  void check_state();
  void check_energy(const Energies& now) const;
  void fail(StepFailure failure) const;
  [[nodiscard]] ObstacleFrame obstacles_now() const { return {obstacles, time(), time()}; }
  [[nodiscard]] double dt() const { return settings.step / state.substeps; }
  [[nodiscard]] double time() const { return steps_done(state) * settings.step; }

  SpringNetwork network;
  SimulatorSettings settings;
  std::shared_ptr<ObstacleSet> shared_obstacles;  ///< shared while a change is made
  ObstacleSet& obstacles;
  External external;
  SpectralBounds bounds;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;
  Forces forces;
  SurfaceAirForce* surface_air = nullptr;  ///< null unless the air acts on faces
  PenaltyContact* penalty = nullptr;       ///< null unless contact is by penalty
  std::optional<Attachments> attachments;  ///< none without attachments in the network
  std::unique_ptr<Integrator> integrator;
  StepConstraints constraints;
  PinPaths pin_paths;
  std::function<bool()> stops;              ///< see Simulator::stop_when
  std::optional<SymmetryBreaker> symmetry;  ///< none unless the settings ask for it
  StepPlanner planner;
  DivergenceCheck divergence;
  EnergyWatch energy_watch;
  SleepGroups groups;
  RestDetector rest;
  Surroundings surroundings;
  SimulationState state;
  SimulationState begin;      ///< of the step
  SimulationState best;       ///< the end of its best attempt, while others are made
  ReactionRecord reactions;   ///< of attachments, and of pins before the last change of the simulator, in the present interval
  double forces_since = 0.0;  ///< begin of that interval [s]
};

}  // namespace sprung
