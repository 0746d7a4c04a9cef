// What the simulator is made of. Internal to simulation/.
#pragma once

#include "dynamics/contact/penalty_contact.h"
#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "simulation/monitoring/divergence.h"
#include "simulation/monitoring/energy_watch.h"
#include "simulation/simulator.h"
#include "simulation/step/step_constraints.h"
#include "simulation/step/step_refinement.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// Where a step that may be made again began.
struct Begun {
  SimulationState state;
  EnergyWatch watch;
  PermittedCrossings through;
};

/// What a step, made in some number of parts, came to.
struct Made {
  SimulationState state;
  EnergyWatch watch;
  PermittedCrossings through;
  StepReport report;
  Index contacts = 0;
};

struct Simulator::Implementation {
  Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> obstacles);

  template <class F, class... Arguments>
  F* add_force(Arguments&&... arguments) {
    auto force = std::make_unique<F>(network, std::forward<Arguments>(arguments)...);
    F* kept = force.get();
    forces.push_back(std::move(force));
    return kept;
  }

  [[nodiscard]] bool anything_moves() const;
  StepReport step();
  [[nodiscard]] int substeps_by_turn() const;
  StepReport make_step(int more, Index too_many);
  [[nodiscard]] Made made(const StepReport& report) const;
  StepReport make_again(const StepReport& first, int more_at_first);
  std::optional<StepReport> attempt(int more, Index too_many);
  StepReport make_substep();
  void choose_substeps(const StepReport& report);
  void set_substeps(int substeps);
  void length_changed(double dt_before);
  void move_pins(double time);
  [[nodiscard]] double elastic_energy() const;
  [[nodiscard]] Energies energies() const;
  [[nodiscard]] Index contacts() const;
  void check_state();
  void check_energy(const Energies& now) const;
  void fail(StepFailure failure) const;
  [[nodiscard]] double dt() const { return settings.step / state.substeps; }
  [[nodiscard]] double time() const { return steps_done(state) * settings.step; }

  SpringNetwork network;
  SimulatorSettings settings;
  Environment environment;
  SpectralBounds bounds;
  std::vector<std::string> warnings;
  Forces forces;
  const Gravity* gravity = nullptr;
  const SpringForce* springs = nullptr;
  const BendingAngleForce* angles = nullptr;  ///< when the network has angle bends
  PenaltyContact* penalty = nullptr;          ///< when contact answers by forces
  std::unique_ptr<Integrator> integrator;
  StepConstraints constraints;
  std::function<bool()> stops;               ///< see Simulator::stop_when
  std::optional<StepRefinement> refinement;  ///< when steps may be made in parts
  bool waits_for_turn;                       ///< see StretchLimit::may_follow_turn
  DivergenceCheck divergence;
  EnergyWatch energy_watch;
  SimulationState state;
  Begun begun;
  std::optional<Index> kept_contacts;  ///< of the last step, if constraints have seen another since
};

}  // namespace sprung
