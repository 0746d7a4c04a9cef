// The simulator: a network, its forces, its environment, and the step.
#pragma once

#include "collision/obstacles/environment.h"
#include "dynamics/forces/force.h"
#include "dynamics/integrators/stable_step.h"
#include "network/simulation_state.h"
#include "network/spring_network.h"
#include "simulation/settings/simulator_settings.h"
#include "simulation/step/step_report.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

class Simulator {
 public:
  /// Throws InputError when settings are out of their bounds, the step is not positive or beyond the largest stable one (unless
  /// `stability` is warn: then `warnings` says so), or when anything intersects at the start that is not pushed
  /// out. Then `warnings` says what was.
  explicit Simulator(SpringNetwork network, SimulatorSettings settings = {}, std::vector<Obstacle> obstacles = {});
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Advances by one step, in as many parts as the step before asks for (see StepRefinement), or as it takes for no obstacle or pin
  /// to turn by more than 45 degrees in one, 64 times as many at most. One that squeezes particles is made again in 4, 16 and 64
  /// times as many, until none is: obstacles that come fast, or near pins, leave a place that a long step passes by. While that
  /// does not help those that squeeze no more are tried ever more rarely. Throws StepError when the network diverged; its state is
  /// of no use then.
  StepReport step();

  /// From now on step() asks this between its parts, and throws StoppedError where it is true; its state is of no use then. A step
  /// of something that is knotted may take long.
  void stop_when(std::function<bool()> stops);

  [[nodiscard]] const SpringNetwork& network() const;
  [[nodiscard]] const SimulatorSettings& settings() const;
  [[nodiscard]] const SimulationState& state() const;
  [[nodiscard]] const Environment& environment() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;

  /// state().step * settings().step [s], between steps
  [[nodiscard]] double time() const;

  /// Positions [m], 3 x n.
  [[nodiscard]] const Points& positions() const { return state().x; }

  /// What solves the stretch limit of this network, as StretchLimit::chosen_solver; empty without a limit.
  [[nodiscard]] std::string stretch_solver() const;

  /// Particles that obstacles push at present.
  [[nodiscard]] Index contact_count() const;

  /// Throws StepError when a spring gave way, or the energy exploded, that the check of the steps, which looks at large networks
  /// only now and then, has not seen yet.
  void check() const;

  /// Elastic energy [J], sum 1/2 k_s (|s| - d)^2 and that of angle bends, and -m g . x.
  [[nodiscard]] double elastic_energy() const;
  [[nodiscard]] double gravity_energy() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
