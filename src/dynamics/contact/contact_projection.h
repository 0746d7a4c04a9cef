// Contact by projection: finds the contacts of a step, answers them on positions and velocities, and has the last word.
#pragma once

#include "collision/obstacles/environment.h"
#include "collision/truncation/step_truncation.h"
#include "dynamics/contact/contact_solver.h"
#include "dynamics/integrators/integrator.h"
#include "network/spring_network.h"

#include <set>
#include <vector>

namespace sprung {

class ContactProjection {
 public:
  /// Keeps references to the network and the environment.
  ContactProjection(const SpringNetwork& network, Environment& environment);

  /// Whether there is anything that the network may meet: obstacles, other bodies, itself.
  [[nodiscard]] bool can_collide() const { return free_space_.can_collide(); }

  /// Finds the contacts of a step. Requires that the environment's interval is the step's.
  void find(const StepMotion& motion);

  /// Finds those around what truncation has stopped anew where the particles are now [m], which the regions must hold: while it
  /// relaxes. Pushes so far count on.
  void find_again(const StepMotion& motion, const Points& positions);

  /// See StepTruncation.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const { return free_space_.permitted_crossings(); }
  void roll_back(const PermittedCrossings& permitted) { free_space_.roll_back(permitted); }
  void look_ahead(bool ahead) { free_space_.look_ahead(ahead); }

  /// See ContactSolver.
  double project(Points& positions) { return response_.project(positions); }
  void settle_velocities(const StepMotion& motion, SimulationState& state, const Integrator& integrator) {
    response_.settle_velocities(motion, state, integrator);
  }
  void hold_pushed(ConstrainedDirections& held) const { response_.hold_pushed(held); }
  [[nodiscard]] Index contact_count() const { return response_.pushed_count(); }

  /// Stops particles before an element of the network crosses a surface, where none did at the begin of the step: the last word on
  /// positions [m]. What is stopped `relax` may lead on (see StepTruncation::truncate); what two bodies stop of each other is
  /// answered as contact first, which keeps their momentum.
  void truncate(const StepMotion& motion, Points& positions, const StepTruncation::Relax& relax = {});

  /// Slows what truncation took along with obstacles down to the speed that forces gave it: what is far from one that spins was
  /// swung about it. What leans on it contact speeds up. Requires velocities that are recovered from positions.
  void slow_down_taken_along(const StepMotion& motion, SimulationState& state, const Integrator& integrator) const;

  [[nodiscard]] Index truncated_count() const { return truncated_; }
  [[nodiscard]] Index infeasible_count() const { return infeasible_; }

 private:
  [[nodiscard]] TruncationResult truncate_bodies(const StepMotion& motion, Points& positions, const StepTruncation::Relax& relax);
  [[nodiscard]] bool note_meetings(const std::vector<Contact>& meetings, const StepMotion& motion);
  [[nodiscard]] bool answer_meetings(Points& positions);

  ContactSolver response_;
  StepTruncation free_space_;
  std::set<decltype(Contact::particles)> noted_;  ///< those of meetings in the step, that contact did not tell of
  std::vector<Index> taken_along_;
  Index truncated_ = 0;
  Index infeasible_ = 0;
};

}  // namespace sprung
