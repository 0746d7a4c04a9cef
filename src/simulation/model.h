// Model: the data of a simulation that no step changes.
#pragma once

#include "collision/obstacles/obstacle_set.h"
#include "dynamics/forces/force.h"
#include "dynamics/integrators/spectral_bounds.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

struct Scratch;

/// Writes to a state with which settings it is made.
void note_settings(const SimulatorSettings& settings, SimulationState& state);

/// How a simulation begins, if not as its network was built: as another one of the same bodies ended. The network's positions stay
/// those at rest.
struct StartState {
  Points positions{};                  ///< [m], 3 x n; empty: those of the network, and what follows is empty too
  Points velocities{};                 ///< [m/s], 3 x n; those of pinned particles are not used
  std::vector<double> rest_lengths{};  ///< of springs [m], if any may yield; empty: those of the network
  std::vector<char> broken{};          ///< whether each spring is gone, if any may break; empty: none is
  Slip slip{};                         ///< of friction; empty: none
};

struct BuildCounts {
  std::int64_t models = 0;
  std::int64_t bounds = 0;  ///< of the largest stable step
};

/// The network with all its springs and pins, the settings, the obstacles, and what was found at the start. All members are
/// thread-safe: many simulators share one model.
class Model {
 public:
  /// Throws InputError if a setting is out of its bounds, if the step is not positive or beyond the largest stable one (with
  /// `stability` warn, `warnings` reports the latter), or if intersections remain at the start. Costs as much as several hundred
  /// steps: it finds the largest stable step, the trees of obstacles, and intersections at the start.
  [[nodiscard]] static std::shared_ptr<const Model> build(SpringNetwork network, SimulatorSettings settings = {},
                                                          std::vector<Obstacle> obstacles = {}, const StartState& start = {});

  /// The same. `scratch` gets the memory in which the start was found.
  [[nodiscard]] static std::shared_ptr<const Model> build(SpringNetwork network, SimulatorSettings settings,
                                                          std::vector<Obstacle> obstacles, const StartState& start,
                                                          std::unique_ptr<Scratch>& scratch);

  /// A model of the same particles and obstacles, which starts like another one. The largest stable step accounts for the elements
  /// that `forces` append. Throws InputError as build(), but does not look for intersections.
  [[nodiscard]] static std::shared_ptr<const Model> changed(const Model& before, SpringNetwork network, SimulatorSettings settings,
                                                            const std::vector<std::shared_ptr<Force>>& forces);

  [[nodiscard]] const SpringNetwork& network() const { return network_; }
  [[nodiscard]] const SimulatorSettings& settings() const { return settings_; }
  [[nodiscard]] const ObstacleSet& obstacles() const { return *obstacles_; }
  [[nodiscard]] const SpectralBounds& bounds() const { return bounds_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  /// Changes that the settings asked for, such as bodies that `push_out` moved; a sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// The state at time 0.
  [[nodiscard]] const SimulationState& initial_state() const { return initial_state_; }

  /// What this process has built so far, for tests.
  [[nodiscard]] static BuildCounts build_counts();

 private:
  Model(SpringNetwork network, SimulatorSettings settings, std::shared_ptr<const ObstacleSet> obstacles,
        const std::vector<std::shared_ptr<Force>>& forces);

  SpringNetwork network_;
  SimulatorSettings settings_;
  std::shared_ptr<const ObstacleSet> obstacles_;
  SpectralBounds bounds_;
  std::vector<std::string> warnings_;
  std::vector<std::string> notes_;
  SimulationState initial_state_;
};

}  // namespace sprung
