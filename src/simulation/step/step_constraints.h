// The constraints of a step after forces have advanced the state: contact, the stretch limit, other constraints, and truncation.
#pragma once

#include "base/files/binary_archive.h"
#include "dynamics/attachments/rods.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/contact/contact_projection.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "simulation/settings/simulator_settings.h"
#include "simulation/step/step_planner.h"

#include <optional>

namespace sprung {

class StepConstraints {
 public:
  /// Keeps references to the network, the settings, the contacts and the integrator.
  StepConstraints(const SpringNetwork& network, const SimulatorSettings& settings, ContactProjection& contacts,
                  Integrator& integrator, bool has_obstacles);

  /// Stores positions and velocities at the beginning of a substep. Call it before forces and pins move the state.
  void begin(const SimulationState& state);

  /// See StepTruncation.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const { return contacts_.permitted_crossings(); }
  /// Restores the permitted crossings, and discards cached regions and factors. Call it after the state was rolled back.
  void roll_back(const PermittedCrossings& permitted) {
    contacts_.roll_back(permitted);
    if (limit_) limit_->forget_solves();
  }
  /// Writes cached regions and factors.
  void save(ByteWriter& to) const {
    contacts_.save(to);
    if (limit_) limit_->save_solves(to);
  }
  /// Reads them back, after roll_back(). Throws BytesError if they are of another network, limit or obstacles; call roll_back()
  /// again then.
  void load(BinaryReader& from) {
    contacts_.load(from);
    if (limit_) limit_->load_solves(from);
  }
  /// The largest one by gravity and wind [m/s^2].
  void set_steady_acceleration(double acceleration) { steady_acceleration_ = acceleration; }

  /// Makes the substeps that follow as planned.
  void follow(const StepPlan& plan) {
    global_limit_ = plan.global_limit;
    inner_ = plan.inner;
  }

  /// Adds a constraint that passes restore in each step.
  void add(std::shared_ptr<Constraint> constraint) { constraints_.push_back(std::move(constraint)); }

  /// Adds rods, for which the global solve of the stretch limit solves too.
  void add_rods(std::shared_ptr<Rods> rods) {
    constraints_.push_back(rods);
    rods_ = std::move(rods);
  }

  /// Projects the advanced state onto contact, constraints and the stretch limit, and recovers the velocities at the end of the
  /// substep of `dt` [s], in the interval of `part`. Contacts are found in the first inner substep of a contact step, whose
  /// interval is that of `frame`; the last one truncates. Adds counts and the remaining stretch to the report. Requires begin().
  void apply(const ObstacleFrame& frame, const ObstacleFrame& part, SimulationState& state, const Forces& forces, double dt,
             StepReport& report);

  /// Moves particles from rest onto the stretch limit and the constraints, as far as obstacles and other bodies permit. Velocities
  /// stay as they are. Call it at the start, and when a limit or constraint changed: a step would give particles the velocity of
  /// that motion (pre-stabilization: Macklin et al. 2014). `frame` has the obstacles at the present time.
  void correct_positions(const ObstacleFrame& frame, SimulationState& state, double dt);

  /// The largest residual of the constraints that were added (see Constraint).
  [[nodiscard]] double violation(const Points& positions) const { return residual(constraints_, positions); }

  /// Positions at the beginning of the step [m], 3 x n. Valid after apply().
  [[nodiscard]] const Points& positions_before(const SimulationState& state) const {
    return copies_positions() ? before_ : state.x_previous;
  }

  [[nodiscard]] const StretchLimit* limit() const { return limit_ ? &*limit_ : nullptr; }  ///< null without settings for it
  [[nodiscard]] const ContactProjection& contacts() const { return contacts_; }

 private:
  void find_contacts(const ObstacleFrame& frame, const ObstacleFrame& part);
  void project(SimulationState& state, const Forces& forces, StepReport& report);
  [[nodiscard]] std::optional<int> solve_limit(SimulationState& state);
  void make_passes(SimulationState& state, StepReport& report);
  void respond_to_contact(SimulationState& state, const Forces& forces);
  void end_substep(const ObstacleFrame& frame, SimulationState& state, const Forces& forces, StepReport& report);
  void end_contact_step(const ObstacleFrame& frame, SimulationState& state, const Forces& forces, StepReport& report);
  void add_displacement(const Points& displaced, SimulationState& state) const;
  [[nodiscard]] int max_relax_rounds() const;
  [[nodiscard]] int passes_of_limit() const;
  [[nodiscard]] int constraint_passes() const;
  [[nodiscard]] bool relax(const ObstacleFrame& frame, Points& positions, double excess_before, double violation_before);
  [[nodiscard]] bool respond_to_truncation(SimulationState& state, const Forces& forces);
  [[nodiscard]] bool projects_contacts() const;
  [[nodiscard]] bool copies_positions() const { return contacts_.can_collide() || !integrator_.keeps_positions(); }
  [[nodiscard]] StepMotion motion() const { return {before_, v_before_, slip_before_, advanced_, dt_}; }
  [[nodiscard]] StepMotion contact_step() const {
    return inner_ > 1 ? StepMotion{first_before_, v_before_, slip_before_, predicted_, inner_ * dt_} : motion();
  }
  [[nodiscard]] bool is_last() const { return inner_number_ + 1 == inner_; }

  const SpringNetwork& network_;
  const SimulatorSettings& settings_;
  double steady_acceleration_ = 0.0;
  Integrator& integrator_;
  std::optional<StretchLimit> limit_;
  ContactProjection& contacts_;
  Constraints constraints_;
  std::shared_ptr<Rods> rods_;  ///< one of them; none without attachments

  // State of the present contact step.
  int inner_ = 1;         ///< number of its inner substeps
  int inner_number_ = 0;  ///< of the present one
  Points first_before_;   ///< positions at its beginning, if there are several
  Points predicted_;      ///< where forces alone would end it, if there are several

  // State of the present inner substep.
  Points before_;                      ///< positions at the beginning; for contact, or if the integrator does not keep them
  Points v_before_;                    ///< velocities at the beginning; for contact
  Slip slip_before_;                   ///< slip at the beginning; for contact
  Points advanced_;                    ///< positions after forces and pins; for contact, or if the integrator needs them
  ConstrainedDirections constrained_;  ///< of the last call of Integrator::respond_to_contact
  Points responded_;                   ///< positions after that call
  double dt_ = 0.0;
  ImpulseRecorder recorder_;  ///< off between steps
  bool global_limit_ = true;  ///< see StepPlan
};

}  // namespace sprung
