// The simulator: a network, its forces, its obstacles, and the step.
#pragma once

#include "collision/shapes/obstacle.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"
#include "simulation/reaction.h"
#include "simulation/settings/simulator_settings.h"
#include "simulation/step/step_report.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

class Constraint;
class Force;
class Model;
class ObstacleFrame;
struct Checkpoint;
struct StartState;

/// A rod or spring that broke.
struct BrokenLink {
  std::string attachment;  ///< its name
  Index particle = kNone;  ///< at its first end
  std::int64_t step = 0;   ///< number of the step after which it broke
};

/// The model and its state, with steps and changes.
///
/// A copy shares the model and the added forces and constraints, and continues as its original would, bit by bit.
///
/// Threads: several simulators may be used at the same time, also copies, if their added forces and constraints permit that (see
/// Force and Constraint). Of one simulator, const members may be called at the same time. A member that is not const must be alone.
/// Costs: constant, below a microsecond, unless a member states its cost.
class Simulator {
 public:
  /// Throws as Model::build, and costs as much.
  explicit Simulator(SpringNetwork network, SimulatorSettings settings = {}, std::vector<Obstacle> obstacles = {});
  /// The same, but the simulation begins as another one ended.
  Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles, const StartState& start);

  /// At the start of a model, which others may share. Costs as much as a copy.
  explicit Simulator(const std::shared_ptr<const Model>& model);

  ~Simulator();
  /// Costs about as much as a few dozen steps. So does the assignment of a copy.
  Simulator(const Simulator& other);
  Simulator& operator=(const Simulator& other);
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Advances by one step. StepPlanner divides it into substeps, and may repeat it with others. Throws StepError if the network
  /// diverged; the simulator then is as it was before the call.
  ///
  /// Before a step,
  /// - pins begin and end, at the step nearest to their time;
  /// - springs break that are longer than their break length: network() then lacks them and the faces that tore (Surface::torn);
  /// - groups of particles fall asleep or wake (see RestDetector and Surroundings): particles that sleep have no inverse masses. If
  ///   all sleep, a step changes the time alone. If a step makes a neighbour of a sleeping group restless, the body of that group
  ///   wakes and the step is repeated.
  /// Last, springs that yield get new rest lengths in network().
  StepReport step();

  /// Continues from a state of this simulator, of a copy of it, or of another simulator of the same network, settings and
  /// obstacles. Gravity, air, limits, stiffness and materials stay as they are now. Added forces and constraints are not part of
  /// the state; the simulator must have the same number, in the same order. The step and the kind of the integrator must be those
  /// with which the state was made. Other differences between the simulators are not noticed, such as stiffness, masses, shapes and
  /// motions of obstacles.
  /// Results may differ from those of the simulator that had the state, which has caches of former steps: in last digits, or,
  /// where fast bodies collide, in which contacts are found. All simulators that are restored to one state agree bit by bit. Costs
  /// about as much as a few steps. Throws InputError if the state does not fit the network, the settings or the obstacles; the
  /// simulation then continues as before.
  void restore(const SimulationState& state);

  /// The state and the caches: a simulator of the same network, settings, obstacles, added forces and constraints that is restored
  /// to it continues as this one would, bit by bit. Costs about as much as a few steps; include simulation/checkpoint.h to use it.
  [[nodiscard]] Checkpoint checkpoint() const;

  /// As restore() of a state. Throws InputError also if bodies differ. Caches of another network, limit or obstacles are ignored.
  void restore(const Checkpoint& checkpoint);

  /// Writes the checkpoint into a file, which is on the disk when this returns. Throws FileError; a former file then stays. Costs
  /// about 5 ms per megabyte, and the time of the disk; a cloth has 0.2 to 0.6 kB a particle, near a mesh up to 2.5 kB, and more
  /// where Newton's method keeps a factor.
  void save(const std::filesystem::path& file) const;

  /// Restores a saved checkpoint, or that of a run. Throws FileError if the file cannot be read, is no such file, is truncated or
  /// damaged, or was written by another version; InputError as restore(). The simulation then continues as before.
  void load(const std::filesystem::path& file);

  /// Lets step() call `stops` before each substep and throw StoppedError if it returns true; the simulator then is as it was before
  /// the step. A step with many infeasible particles can take minutes. A copy of the simulator has none.
  void stop_when(std::function<bool()> stops);

  // Changes between two steps. The state remains: positions, velocities, time, and bodies that a global solve took over. All
  // particles wake. References to network() and settings() become invalid. Each throws InputError that names every problem; the
  // simulation then continues as before. A new model costs about as much as the constructor without its obstacles.

  /// Costs a new model. Continues with another network and other settings. Requires a network that NetworkBuilder made with the
  /// same bodies and the same particles. The settings of the start, the pairs of bodies that collide (Body::contact) and the
  /// contact response cannot change. The step may change with steps_per_frame at the end of a frame. Springs that broke stay
  /// broken, and springs that yielded keep their rest lengths. If the pins are the same, particles that pin() and release() changed
  /// stay so.
  void continue_with(SpringNetwork network, SimulatorSettings settings);

  /// Wakes all particles, and asks added forces and constraints again which particles they touch. Throws InputError if one of them
  /// does not exist. Costs about as much as a few steps if any sleep.
  void wake();

  /// [m/s^2]. Costs less than a hundredth of a step; with a quadratic SimulatorSettings::air_surface a new model, as its bound
  /// depends on the speed of a fall.
  void set_gravity(const Vector3& acceleration);
  /// See SimulatorSettings. Costs a new model, but another wind alone less than a hundredth of a step, with the same exception and
  /// one more: bodies with a drag of their own need a new model for a wind faster than any before.
  void set_air(double drag, const Wind& wind);

  /// Springs that exceed the new limit are shortened at once, as far as obstacles and bodies permit; velocities stay as they are.
  /// Costs a new model.
  void set_stretch_limit(const std::optional<StretchLimitSettings>& limit);

  /// Gives all springs of a kind in a body this stiffness [N/m] and damping [N s/m]. Throws InputError also if there are none.
  /// Costs a new model.
  void set_springs(std::size_t body, SpringKind kind, double stiffness, double damping);

  /// Costs a new model.
  void set_body_material(std::size_t body, const ContactMaterial& material);
  /// Costs less than a hundredth of a step, but another thickness a few dozen steps.
  void set_obstacle_material(std::size_t obstacle, const ContactMaterial& material);

  /// Fixes a particle where it is. Does nothing if it is pinned already. A pin of the network that begins later leaves it out.
  /// Returns the number of its pin, whose name is `rope.particles[3]`, or a variant if others have that name. Costs about as much
  /// as a few steps.
  std::size_t pin(Index particle);

  /// Fixes particles where they are, relative to each other; those that are pinned already stay with their pin. The name is that of
  /// the reaction, and a pin of this name that a program added before ends. The pose of the pin is at the mean of the particles.
  /// Throws InputError also if the name is that of a pin or an attachment of the network. Costs about as much as a few steps.
  std::size_t pin(const std::vector<Index>& particles, const std::string& name);

  /// Frees a particle from its pin; it continues with the pin's velocity. Does nothing if it is not pinned. Costs about as much as
  /// a few steps. If the pin always holds, the spectral bounds are computed again.
  void release(Index particle);

  /// Continues from other positions [m] and velocities [m/s] of all particles, 3 x n. Pinned particles must stay where they are and
  /// keep the velocities of their pins. No particle may pass through an obstacle on the straight path to its new position, and
  /// bodies may intersect nothing there that they do not intersect already. Wakes all particles. Does nothing if no number
  /// differs. Costs as much as a step, and as much as the check of a start if a position differs.
  void set_motion(const Points& positions, const Points& velocities);

  // Steering. The next step moves a pin or an obstacle to a pose, on a line and with the shortest rotation; its velocity follows.
  // It then stays there, whatever keyframes it had, until it is moved again. Call it before each step. A step may move no point
  // farther than the size of the largest body: contact is found up to that distance, and no body is stretched to more than twice
  // its size. A pin may still drag elements through an obstacle. Throws InputError if the pose is not a rotation and a
  // translation, or too far; it then names the distance, and the number of steps to go there in.

  /// Moves the particles of a pin by the rigid motion from its present pose to `pose`. Throws InputError for pins that follow an
  /// obstacle, and for pins that hold no particle.
  /// Costs about as much as a few steps at the first call for a pin, then a time that grows with its particles.
  void move_pin(std::size_t pin, const RigidTransform& pose);
  /// Costs about as much as a few steps at the first call for an obstacle.
  void move_obstacle(std::size_t obstacle, const RigidTransform& pose);

  [[nodiscard]] RigidTransform pin_pose(std::size_t pin) const;  ///< now; of a pin without motion: a translation to its origin
  [[nodiscard]] RigidTransform obstacle_pose(std::size_t obstacle) const;  ///< now

  /// Adds an external force that was not added yet. The caller may change its parameters between steps. The force must not keep
  /// references to network(). The largest stable step accounts for the elements that the force appends: it is found anew if there
  /// are any. Throws InputError if the step is beyond it, or if the force names particles that do not exist. The energy is not
  /// checked while there are external forces, as they may supply any amount. Only the particles that the force touches
  /// (Force::touched) stay awake. Costs a few dozen steps, and the bounds of a new model for elements.
  void add_force(std::shared_ptr<Force> force);

  /// Adds a constraint that was not added yet. The passes of each step restore it. Throws InputError if it touches particles that
  /// do not exist. The caller may change its parameters between steps. The constraint must not keep references to network(). The
  /// energy is not checked while there are added constraints. Costs a few dozen steps.
  void add_constraint(std::shared_ptr<Constraint> constraint);

  /// Removes a constraint. Does nothing if it was not added. Costs a few dozen steps.
  void remove_constraint(const Constraint& constraint);

  /// Removes an external force. Does nothing if it was not added. Costs a few dozen steps.
  void remove_force(const Force& force);

  /// What no step changes. Any thread may use it.
  [[nodiscard]] const std::shared_ptr<const Model>& model() const;
  /// The network as it is now: without springs that broke, with the present rest lengths, pins and sleepers.
  [[nodiscard]] const SpringNetwork& network() const;
  [[nodiscard]] const SimulatorSettings& settings() const;
  [[nodiscard]] const SimulationState& state() const;
  [[nodiscard]] const std::vector<Obstacle>& obstacles() const;
  /// The obstacles at time(). Include collision/obstacles/obstacle_frame.h to use it. The cost grows with their number.
  [[nodiscard]] ObstacleFrame obstacle_frame() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;
  /// Changes that the settings asked for, such as bodies that `push_out` moved; a sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const;

  /// Time [s], between steps: whole_steps(state()) * settings().step.
  [[nodiscard]] double time() const;

  /// Positions [m], 3 x n.
  [[nodiscard]] const Points& positions() const { return state().x; }

  /// Name of the solver of the stretch limit (see StretchLimit::chosen_solver); empty without a limit.
  [[nodiscard]] std::string stretch_solver() const;

  /// Number of particles that contact pushed in the last step. Costs as much as contact_particles().
  [[nodiscard]] Index contact_count() const;

  /// These particles, ascending. Grows with the number of contacts.
  [[nodiscard]] std::vector<Index> contact_particles() const;

  /// The rods and springs of attachments that broke so far, in the order of the attachments; grows with their number.
  [[nodiscard]] std::vector<BrokenLink> broken_links() const;

  /// Throws StepError if a spring is overstretched or the energy exploded. step() checks large networks only every few steps. Grows
  /// with the number of springs, as the next three do.
  void check() const;

  /// Elastic energy [J]: sum of 1/2 k_s (|s| - d)^2 of springs and attachments, the energy of angle bends, -p V of bodies with a
  /// pressure, and the energies of added forces. Potential energy of gravity [J]: sum of -m g . x. Energy of contact [J]: that of
  /// penalty springs; 0 with projection.
  [[nodiscard]] double elastic_energy() const;
  [[nodiscard]] double gravity_energy() const;
  [[nodiscard]] double contact_energy() const;

  // With SimulatorSettings::record_forces. The cost grows with the number of pins, attachments and springs.

  /// The mean force [N] of each pin on its body, then of each attachment on its first ends, since reset_forces() or time 0: impulse
  /// by time, in the order in which they were added; 0 of those that did not act then. Empty without the setting. Forces on
  /// obstacles are not recorded.
  [[nodiscard]] std::vector<Reaction> reactions() const;

  /// The mean force with which the stretch limit pulled each spring's ends together since then [N]; negative: it pushed. Zero
  /// without the setting.
  [[nodiscard]] Scalars limit_tensions() const;

  // With SimulatorSettings::record_contact_forces. The cost grows with the number of particles.

  /// The mean force of contact on each particle since reset_forces() or time 0 [N], 3 x n: normal force and friction of obstacles
  /// and bodies. Zero without the setting. Inexact in steps in which truncation acts, in impacts with a penalty, whose force at the
  /// end of substeps counts, and on pinned particles in implicit Euler's response to contact between bodies.
  [[nodiscard]] Points contact_forces() const;

  /// Begins a new interval for reactions(), limit_tensions() and contact_forces().
  void reset_forces();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
