// What holds a step once forces have led it on: contact and the stretch limit, and contact's last word.
#pragma once

#include "dynamics/contact/contact_projection.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "simulation/settings/simulator_settings.h"
#include "simulation/step/step_report.h"

#include <optional>

namespace sprung {

class StepConstraints {
 public:
  /// Keeps references to the network, the settings, the environment and the integrator. `steady_acceleration` [m/s^2] is the
  /// largest that gravity and wind give.
  StepConstraints(const SpringNetwork& network, const SimulatorSettings& settings, double steady_acceleration,
                  Environment& environment, Integrator& integrator);

  /// Takes down where a step begins. It is for what comes before hold(): forces, and pins that move.
  void begin(const SimulationState& state);

  /// See StepTruncation.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const { return contacts_.permitted_crossings(); }
  void roll_back(const PermittedCrossings& permitted) { contacts_.roll_back(permitted); }
  void look_ahead(bool ahead) { contacts_.look_ahead(ahead); }

  /// Leads the state on from where forces and pins have led it in `dt` [s]: by contact, the stretch limit and truncation, to the
  /// positions and velocities of the step's end. Adds to the report what that took and left. Requires that the environment's
  /// interval is the step's.
  void hold(SimulationState& state, const Forces& forces, double dt, StepReport& report);

  /// Positions at the step's begin [m], 3 x n. Valid after hold().
  [[nodiscard]] const Points& step_began(const SimulationState& state) const {
    return copies_positions() ? before_ : state.x_previous;
  }

  [[nodiscard]] const StretchLimit* limit() const { return limit_ ? &*limit_ : nullptr; }  ///< none without settings for it
  [[nodiscard]] const ContactProjection& contacts() const { return contacts_; }

 private:
  /// What contact alone did.
  struct PushOut {
    int passes = 0;
    bool any = false;  ///< whether anything was moved
  };

  void constrain(SimulationState& state, const Forces& forces, StepReport& report);
  void answer_contact(SimulationState& state, const Forces& forces);
  [[nodiscard]] PushOut push_out(Points& positions, int most_passes);
  void truncate(SimulationState& state, const Forces& forces, StepReport& report);
  [[nodiscard]] bool relax(Points& positions, double excess_before);
  [[nodiscard]] bool answer_truncation(SimulationState& state, const Forces& forces);
  [[nodiscard]] bool projects_contacts() const;
  [[nodiscard]] bool copies_positions() const { return contacts_.can_collide() || !integrator_.keeps_positions(); }
  [[nodiscard]] StepMotion motion() const { return {before_, v_before_, advanced_, dt_}; }

  const SimulatorSettings& settings_;
  double steady_acceleration_;
  Integrator& integrator_;
  std::optional<StretchLimit> limit_;
  ContactProjection contacts_;

  // Of the step at hand: where it began, and where forces and pins alone would have ended it.
  Points before_;               ///< for contact, and where the integrator does not keep them
  Points v_before_;             ///< for contact alone
  Points advanced_;             ///< for contact, and for integrators that need it
  ConstrainedDirections held_;  ///< those of the last answer to contact
  Points answered_;             ///< where the last answer to contact led, for integrators that give one
  double dt_ = 0.0;
};

}  // namespace sprung
