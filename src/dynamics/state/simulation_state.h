// All that a step changes. Time is counted in frames, steps and substeps, never accumulated.
#pragma once

#include "base/types.h"
#include "collision/obstacle_regions/permitted_crossing.h"
#include "dynamics/state/recorded_impulses.h"
#include "network/model/activity.h"
#include "network/model/attachment.h"
#include "network/model/springs.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// Passes remove the excess of an impact in fewer steps than this, and substeps have reached their smallest length by then.
inline constexpr int kFirstPatience = 16;

/// The stretch limit of one body: passes or a global solve enforce it.
struct StretchHandover {
  int missed_steps = 0;           ///< consecutive steps, up to the last one, in which the present solver missed the limit
  int patience = kFirstPatience;  ///< missed steps after which the other solver is tried
  std::optional<std::int64_t> solved_since;  ///< the step after which the global solve took over; none: passes enforce the limit
};

struct LimitMemory {
  std::vector<StretchHandover> handovers{};  ///< one entry per body
};

/// The motion of a sleep group or a body, see RestDetector.
struct MotionHistory {
  double in_frame = 0.0;       ///< the largest visible displacement in a frame of the present window [m]
  bool was_invisible = false;  ///< whether its motion was invisible in the last window
  bool is_at_rest = false;     ///< whether it was at rest at the end of the last window
};

/// Which groups are at rest, and which sleep in the next step.
struct RestMemory {
  std::optional<double> window_begin{};    ///< of the present window of RestDetector [s]; none at first
  int frames = 0;                          ///< number of completed frames of the present window
  Points x_at_frame{};                     ///< positions at the begin of the present frame [m], 3 x n
  std::array<Points, 3> x_at_begins{};     ///< those at the begins of the present window and the two before [m]
  Points x_beside_sleep{};                 ///< those at the begin of the window or, while a neighbour sleeps, when it fell asleep
  std::vector<MotionHistory> histories{};  ///< of each sleep group, then of each body
  std::vector<char> sleepers{};            ///< whether each sleep group sleeps in the next step
};

/// What friction with obstacles remembers of each particle.
struct Slip {
  Points displacement;          ///< along the obstacle since the particle stuck to it [m], 3 x n; zero without a contact
  std::vector<Index> obstacle;  ///< that the particle touches, n; kNone without a contact
};

/// A touching contact at a particle.
struct ContactNormal {
  Index particle = kNone;
  Vector3 normal = Vector3::Zero();  ///< unit length, towards the side to which the contact pushes the particle
};

/// What contact remembers, by projection.
struct ContactMemory {
  Slip slip{};                  ///< since particles stuck to obstacles
  std::vector<Index> pushed{};  ///< particles that contact pushed in the last step, ascending; a sleeping particle keeps its entry
  std::vector<ContactNormal> normals{};    ///< of touching contacts at its end, for each particle that they can move
  PermittedCrossings permitted_crossings;  ///< of elements that a pin pulled through an obstacle
};

/// The energies and speeds so far that bound the energy that can have been supplied, see EnergyWatch.
struct EnergyMemory {
  double start = 0.0;            ///< of motion and springs, at the start [J]
  double highest_gravity = 0.0;  ///< largest potential energy of gravity [J]
  double stored = 0.0;           ///< energy of springs that was supplied slowly [J]
  double max_kinetic = 0.0;      ///< [J]
  double fastest_drive = 0.0;    ///< of pins and obstacles [m/s]
  bool is_stale = false;         ///< energies have to be recorded as after a change, before the next step
};

/// Position of a particle when its pin began.
struct PinGrip {
  Index particle = kNone;
  double from = 0.0;                   ///< Pin::from of its pin [s]
  double time = 0.0;                   ///< [s]
  Vector3 position = Vector3::Zero();  ///< [m]
  Index triangle = kNone;              ///< nearest then, of a deforming obstacle that the pin follows
};

/// Why a step has the substeps that it has.
enum class PlanReason : std::uint8_t {
  first,         ///< it needs no more than one
  excess,        ///< former steps missed the stretch limit
  deformation,   ///< bodies that a global solve keeps within the limit deform or rotate
  rotation,      ///< an obstacle or pin rotates far
  infeasible,    ///< with fewer, particles had no admissible position
  solver_trial,  ///< another solver of the stretch limit was better
  wake,          ///< it was repeated with some sleepers awake
  strain         ///< with fewer, truncation strained a spring
};

/// What StepPlanner has learnt from former steps.
struct PlannerMemory {
  PlanReason reason = PlanReason::first;  ///< of SimulationState::substeps
  int calm_steps = 0;                     ///< consecutive steps that did not need their substeps
  int feasible_steps = 0;                 ///< consecutive steps without infeasible particles
  std::int64_t retry_from = 0;            ///< steps before this one are not repeated because of infeasible particles
  int retry_wait = 0;                     ///< number of steps to wait after a repetition without effect
  Index retry_infeasible = 0;  ///< exception: steps with more infeasible particles than this are repeated despite the wait
};

/// The impulses in the present interval of records, see reaction_record.h.
struct ReactionMemory {
  std::map<std::string, Vector3> impulses{};  ///< of attachments, and of pins before the last change of pins, by name [N s]
  double since = 0.0;                         ///< begin of the interval [s]
};

/// A pin or an obstacle that a program moves.
struct SteeredMotion {
  std::size_t number = 0;  ///< of the pin or obstacle
  /// Poses at: the first move, each later grip of particles, and the begin and end of the last steered step.
  std::vector<TimedPose> poses{};

  [[nodiscard]] bool operator==(const SteeredMotion&) const = default;
};

/// Pins that a program added, and motions of pins and obstacles that it steers.
struct Steering {
  std::vector<Pin> added_pins{};           ///< numbered after those of the model
  std::vector<SteeredMotion> pins{};       ///< by number
  std::vector<SteeredMotion> obstacles{};  ///< by number

  [[nodiscard]] bool operator==(const Steering& other) const;
};

/// Do not edit x and v alone: Verlet moves by x - x_previous, and friction, rest and Verlet's start refer to positions too. Change
/// all of x, v and x_previous together: x_previous = x - v dt.
struct SimulationState {
  std::int64_t step = 0;       ///< number of completed steps
  std::int64_t frame = 0;      ///< number of completed frames
  int step_in_frame = 0;       ///< number of completed steps of the current frame
  int steps_per_frame = 1;     ///< number of equal steps of a frame; it may change at the end of a frame
  int substeps = 1;            ///< number of equal substeps of the current step
  int substep = 0;             ///< number of completed substeps of the current step
  double step_length = 0.0;    ///< of the simulator that made it [s]
  std::size_t integrator = 0;  ///< of that simulator: number in IntegratorSettings
  PlannerMemory planner{};
  Points x;           ///< positions [m], 3 x n
  Points v;           ///< velocities [m/s], 3 x n
  Points x_previous;  ///< Verlet's positions one step ago [m], 3 x n
  Activity activity{};
  SpringState springs{};
  Steering steering{};
  ContactMemory contact{};
  RestMemory rest{};
  EnergyMemory energy{};
  LimitMemory limit{};
  std::vector<PinGrip> grips{};      ///< of pins that move and began after time 0 or follow a deforming obstacle; by particle
  std::vector<Link> links{};         ///< of attachments that have engaged and not ended, by attachment; broken ones too
  RecordedImpulses impulses{};       ///< empty unless the settings ask for forces
  RecordedImpulses last_impulses{};  ///< of the last step; a step adds those of sleeping particles again
  ReactionMemory reactions{};
  std::size_t added_forces = 0;       ///< number of forces that a program added
  std::size_t added_constraints = 0;  ///< likewise

  /// Bit by bit.
  [[nodiscard]] bool operator==(const SimulationState& other) const;
};

/// A number that states share if they are equal bit by bit, and else almost never (FNV-1a; Fowler, Noll and Vo 1991). The same on
/// every machine with the same byte order. The cost grows with the size of the state: about a millisecond per megabyte.
[[nodiscard]] std::uint64_t hash(const SimulationState& state);

/// The number of steps of the present length from time 0 to the begin of the current step. Times are this number, or a fraction
/// more, times the step length.
[[nodiscard]] inline std::int64_t whole_steps(const SimulationState& state) {
  return state.frame * state.steps_per_frame + state.step_in_frame;
}

/// The same, plus the completed fraction of the current step.
[[nodiscard]] inline double steps_done(const SimulationState& state) {
  return static_cast<double>(whole_steps(state)) + static_cast<double>(state.substep) / state.substeps;
}

/// Counts a completed step.
inline void count_step(SimulationState& state) {
  ++state.step;
  if (++state.step_in_frame < state.steps_per_frame) return;
  ++state.frame;
  state.step_in_frame = 0;
}

/// The state at time 0. The integrator, which knows the step, sets x_previous for Verlet.
[[nodiscard]] SimulationState initial_state(const SpringNetwork& network);

}  // namespace sprung
