// Makes the steps of a simulation. Internal to simulation/.
#pragma once

#include "simulation/scratch.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// Values from before a transition, which the transition needs.
struct BeforeTransition {
  Activity activity;
  std::vector<Pin> pins;   ///< that the numbers of the activity mean
  Points last_velocities;  ///< of pinned particles, mean of the last step [m/s], 3 x n
  double dt = 0.0;         ///< [s]
  double excess = 0.0;     ///< over the stretch limit
  double violation = 0.0;  ///< of constraints
};

/// The steps as functions of a model, a control and a state. It keeps references to all, and nothing else. Requires that the
/// scratch follows the state.
class Stepper {
 public:
  Stepper(const Model& model, const Control& control, SimulationState& state, Scratch& scratch)
      : model_(model), control_(control), state_(state), scratch_(scratch) {}

  /// Makes the state at time 0: pins move their particles, bodies leave intersections, attachments engage. Appends messages.
  void start(std::vector<std::string>& warnings, std::vector<std::string>& notes);

  /// Makes a step. If it throws, the state is that at its begin.
  StepReport step();

  /// Continues from a former state of the model. Costs as much as a transition if its springs or its activity differ.
  void restore(const SimulationState& former);

  /// Regions, pairs and factors that former steps left behind. Results depend on them: in last digits, and in which contacts are
  /// found.
  [[nodiscard]] std::string caches() const;
  /// Goes on with these caches. Call it after the state was restored to that of their simulator. Caches of another limit are
  /// ignored. Requires the same network and obstacles.
  void load_caches(std::string_view bytes);

  /// Initializes the workspace from the state.
  void initialize();

  /// Lets forces know gravity and wind. All particles wake in the next step.
  void follow_conditions();

  [[nodiscard]] BeforeTransition before_transition() const;
  /// Updates the scratch after springs, pins or sleepers of the state changed.
  void make_transition(const BeforeTransition& before);
  /// Adopts a state from another model of the same particles, or from another control. Records energies anew.
  void adopt(const BeforeTransition& before, const Model& former);

  /// Continues from other positions and velocities; those of pinned particles stay. Requires that all particles are awake.
  void set_motion(const Points& positions, const Points& velocities);

  void wake_all();
  /// Wakes the groups near moving pins and obstacles.
  void wake_driven();
  /// Moves a pin or an obstacle in the next step.
  void steer(std::vector<SteeredMotion> Steering::*list, std::size_t number, const RigidTransform& present,
             const RigidTransform& target);
  void begin_recording();
  void note_change() { EnergyWatch::note_change(energies(), state_.energy); }

  [[nodiscard]] bool is_start() const { return steps_done(state_) == 0.0; }
  [[nodiscard]] double dt() const { return settings().step / state_.substeps; }
  [[nodiscard]] double time() const { return steps_done(state_) * settings().step; }
  [[nodiscard]] ObstacleFrame obstacles_now() const { return {obstacles(), time(), time()}; }
  [[nodiscard]] double energy(EnergyKind kind) const { return energy_of(work().forces, kind, state_.x); }
  [[nodiscard]] std::vector<Index> contacts() const;
  void check() const;

 private:
  // The step.
  void begin_step(const std::vector<Index>& overlong, double due);
  std::optional<StepReport> attempt(PlanReason reason);
  StepTrial make_trial(const StepPlan& plan);
  StepTrial repeat(const StepPlan& plan);
  void finish_step(std::span<const StepTrial> tried);
  void return_to(const SimulationState& former);
  void load();
  void prepare_step();
  [[nodiscard]] double rotation_in_step() const;
  [[nodiscard]] double time_of(int substep) const;
  StepReport make_substep(int inner);
  void set_substeps(int substeps);
  void substep_changed(double dt_before);
  void step_length_changed();
  void move_pins(double time);
  void record_gain(Index particle, const Vector3& velocity_before);
  void update_attachments();
  void record_attachments();
  void record_penalty();
  void note_contacts();
  void correct_positions(double dt);
  [[nodiscard]] Energies energies() const;
  [[nodiscard]] std::vector<ContactNormal> contact_normals() const;
  void check_state();
  void check_energy(const Energies& now) const;
  void fail(StepFailure failure) const;

  void follow_steering();

  // Transitions.
  void finish_transition(const BeforeTransition& before, bool restarts);
  void change_sleep(const BeforeTransition& before);
  [[nodiscard]] bool change_pins(const BeforeTransition& before);
  void keep_handovers();
  void resume_integrator(double dt);

  // Sleep.
  [[nodiscard]] bool may_sleep() const;
  [[nodiscard]] bool sleeps(Index group) const;
  [[nodiscard]] bool is_free(Index group) const;
  [[nodiscard]] std::vector<char> sleeping_groups() const;
  [[nodiscard]] std::vector<char> particles_to_sleep() const;
  void choose_sleepers();
  void add_sleepers(const Surroundings::Found& found, const std::vector<char>& disturbed);
  [[nodiscard]] std::vector<char> held_groups(const Surroundings::Found& found) const;
  [[nodiscard]] std::vector<char> settling_bodies() const;
  void wake_with_bodies(const std::vector<char>& asleep);
  [[nodiscard]] bool disturbs_sleep(const std::vector<GroupPair>& pairs);
  [[nodiscard]] bool all_sleep() const;
  void add_impulses_of_sleepers(const RecordedImpulses& before);

  [[nodiscard]] const SpringNetwork& network() const { return scratch_.network; }
  [[nodiscard]] const SimulatorSettings& settings() const { return scratch_.settings; }
  [[nodiscard]] const ObstacleSet& obstacles() const { return scratch_.obstacles; }
  [[nodiscard]] Workspace& work() const { return scratch_.work.value(); }
  [[nodiscard]] Structure& structure() const { return *scratch_.structure; }
  [[nodiscard]] Integrator& integrator() const { return *work().integrator; }
  [[nodiscard]] StepConstraints& constraints() const { return work().constraints; }
  [[nodiscard]] const SleepGroups& groups() const { return structure().groups; }

  const Model& model_;
  const Control& control_;
  SimulationState& state_;
  Scratch& scratch_;
  bool has_begun_ = false;  ///< whether `begin` of the scratch is the begin of the present step
};

/// The state in another model of the same particles: springs that broke stay broken, and pins that a program added or moves go on.
[[nodiscard]] SimulationState continued_in(const Model& next, const Model& before, const SimulationState& state);

}  // namespace sprung
