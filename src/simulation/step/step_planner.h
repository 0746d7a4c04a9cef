// Decides into how many substeps a step is divided, whether it is repeated, and which attempt counts.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "simulation/settings/simulator_settings.h"
#include "simulation/step/step_report.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace sprung {

/// A trial of the solver that does not enforce the stretch limit of a body at present.
struct SolverTrial {
  std::size_t body = 0;
  bool newton = false;  ///< whether the trial is of Newton's method, or of passes
};

struct StepPlan {
  int contact_steps = 1;     ///< parts of the step for which contacts are found anew
  int inner = 1;             ///< substeps of each, in which forces and the stretch limit act
  bool global_limit = true;  ///< whether global solves enforce the stretch limit where they do otherwise; or passes alone
  std::optional<SolverTrial> trial{};
  Index abandon_at = std::numeric_limits<Index>::max();  ///< infeasible particles in a substep that end the attempt
  PlanReason reason = PlanReason::first;

  [[nodiscard]] int substeps() const { return contact_steps * inner; }
};

/// An attempt at a step.
struct StepTrial {
  StepPlan plan;
  StepReport report;
  bool is_complete = true;   ///< it was neither abandoned nor did it diverge
  double body_excess = 0.0;  ///< excess over the stretch limit of the body whose solvers are compared, at the end
};

/// All that divides or repeats a step. It is divided into contact steps, and each of them into the inner substeps of the settings,
/// or into one where global solves enforce all limits and forces bear the whole step:
/// - Excess: the length of the contact steps is halved as soon as a step ends with more excess over the stretch limit than the
///   bound, and doubled after eight steps in a row with less than a quarter of the bound. The excess of a swinging body grows with
///   the length of the substep, the excess of a hanging body with its square.
/// - Deformation: global solves satisfy the limit at any step, but their projection damps motion in proportion to the deformation
///   in a substep. Each substep deforms or rotates a body by at most 1/70 (see StretchLimit::deformation).
/// - Rotation: no obstacle or pin rotates by more than 45 degrees in a contact step.
/// - Infeasible: a step with infeasible particles is repeated with 4, 16 and 64 times the contact steps until there are none: a
/// long
///   step can miss an admissible position near a pin or before a fast obstacle. An attempt that does not halve the number
///   of infeasible particles is abandoned, because it could take hundreds of times longer. After a repetition without effect, no
///   step is repeated for a waiting time, which doubles each time and ends after enough feasible steps. A step with more infeasible
///   particles than any during the wait is repeated nevertheless, as its cause may be another.
/// - Strain: where truncation strained a spring by more than a tenth, a step of inner substeps is repeated with 4, then 16 times
/// the
///   contact steps, up to one for each inner substep. The strain would become speed.
/// - Solver trial: a body whose solver missed the limit in several steps in a row tries the other solver on the same step, and
///   keeps it if it leaves less excess. Newton's method costs more, so it must leave at most four fifths of the
///   excess that the passes leave. A body that keeps its solver waits twice as long for its next trial.
class StepPlanner {
 public:
  /// `limit` is null without a stretch limit; references to it and to the network are kept. `forces_need_inner`: forces would not
  /// bear a whole step.
  StepPlanner(const SpringNetwork& network, const SimulatorSettings& settings, const StretchLimit* limit, bool forces_need_inner);

  /// Sets the substeps of the first step. `moves`: whether anything moves at the start, when no deformation is known yet.
  void start(bool moves, SimulationState& state) const;

  /// Sets the substeps after a change between two steps; `restrains`: pins began or ended.
  void note_change(bool restrains, SimulationState& state) const;

  /// The plan of a step that begins at a state. An obstacle or pin rotates by `rotation` [degrees] in it.
  [[nodiscard]] StepPlan first(const SimulationState& begin, double rotation) const;

  /// The plan of the next attempt at the step after those that were tried; none if they are enough.
  [[nodiscard]] std::optional<StepPlan> next(std::span<const StepTrial> tried, const SimulationState& begin) const;

  /// The number of the attempt that counts: the last complete one, unless it is a trial of a solver that is not worth the change.
  [[nodiscard]] std::size_t best(std::span<const StepTrial> tried) const;

  /// Records a step, whose state is that of its best attempt, and sets the substeps of the next one.
  void learn(std::span<const StepTrial> tried, SimulationState& state) const;

  /// The body whose solvers a step that begins at this state compares.
  [[nodiscard]] std::optional<std::size_t> body_to_compare(const SimulationState& begin) const;

 private:
  [[nodiscard]] std::optional<StepPlan> repetition(std::span<const StepTrial> tried, const SimulationState& begin) const;
  [[nodiscard]] std::optional<StepPlan> repetition_for_strain(std::span<const StepTrial> tried, const SimulationState& begin) const;
  void learn_of_repetitions(std::span<const StepTrial> tried, SimulationState& state) const;
  void learn_of_trial(std::span<const StepTrial> tried, SimulationState& state) const;
  void choose_substeps(std::span<const StepTrial> tried, SimulationState& state) const;
  void choose_by_excess(double excess, SimulationState& state) const;
  void choose_by_deformation(double deformation, SimulationState& state) const;
  void count_missed(double excess, SimulationState& state) const;

  [[nodiscard]] int inner(const SimulationState& state) const;
  [[nodiscard]] int contact_steps(const SimulationState& state) const;

  const SpringNetwork& network_;
  const StretchLimit* limit_;
  int inner_substeps_;
  bool forces_need_inner_;
  int max_substeps_;    ///< contact steps that excess and deformation may ask for; 1 without a limit
  bool awaits_newton_;  ///< see StretchLimit::may_follow_deformation
};

}  // namespace sprung
