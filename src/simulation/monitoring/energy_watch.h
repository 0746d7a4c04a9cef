// Watches the energy of a simulation: detects an explosion, and a gain that nothing drives.
#pragma once

#include "collision/shapes/obstacle.h"
#include "dynamics/forces/force.h"
#include "dynamics/state/simulation_state.h"
#include "simulation/settings/simulator_settings.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// Energies of a state [J].
struct Energies {
  double kinetic = 0.0;
  double elastic = 0.0;
  double gravity = 0.0;
  double contact = 0.0;  ///< of penalty springs

  [[nodiscard]] double of_springs() const { return elastic + contact; }
};

/// Detects an explosion: more energy of motion and springs than anything can have supplied. What it saw in former steps is in the
/// state.
class EnergyWatch {
 public:
  /// Sums the capacity of the `forces`.
  EnergyWatch(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles,
              const Forces& forces);

  /// Records the energies at time 0, or after a change between two steps that may have brought energy, as that of a spring.
  static void note_change(const Energies& energies, EnergyMemory& memory);

  /// Records the energies after a step. Step 1 counts as the start too, as limits and contact may add energy in it. Energy of
  /// springs counts as supplied by pins or obstacles while the kinetic energy so far is below 1 % of it: an explosion moves.
  static void note(std::int64_t step, const Energies& energies, EnergyMemory& memory);

  /// Records the speed [m/s] of a pin.
  static void note_pin(double speed, EnergyMemory& memory) { memory.fastest_drive = std::max(memory.fastest_drive, speed); }

  /// Records the speed [m/s] at which an obstacle may hit a body. A body that bounces with restitution e between two obstacles that
  /// approach at speed v reaches v (1 + e) / (1 - e), as each bounce turns its speed u into e (u + v) + v. A closing wedge
  /// accelerates its content by 1 / tan(angle), taken as at most 32 (2 degrees).
  void note_obstacle(double speed, EnergyMemory& memory) const {
    if (speed > 0.0) memory.fastest_drive = std::max(memory.fastest_drive, bounce_gain_ * speed);
  }

  /// Describes the explosion if the energies of motion and springs exceed 1,000 times the energy that can have been supplied. That
  /// is the sum of: the energy at the start; the potential energy released since; the energy supplied slowly (see note()); the
  /// kinetic energy of all particles at the speed of the fastest pin, wind or obstacle; the capacity of the
  /// forces (see Force::capacity); with a stretch limit, the energy to lift all particles by one spring length; and rounding.
  [[nodiscard]] std::optional<std::string> explosion(const Energies& energies, const EnergyMemory& memory) const;

 private:
  [[nodiscard]] double supplied(const Energies& energies, const EnergyMemory& memory) const;

  double mass_;         ///< [kg]
  double wind_;         ///< largest speed [m/s]
  double bounce_gain_;  ///< factor on the speed of obstacles
  double capacity_;     ///< of forces and limits [J]
};

struct FrameEnergy {
  int frame = 0;
  double energy = 0.0;  ///< [J]
};

/// What EnergyGain remembers of the frames so far.
struct EnergyGainMemory {
  double max_kinetic = 0.0;           ///< of frames [J]
  std::optional<FrameEnergy> lowest;  ///< frame of the smallest total energy
  FrameEnergy rise_begin;             ///< of the largest rise
  FrameEnergy rise_end;
};

/// Answers at the end of a run: did the energy rise between two frames, although nothing drives the scene? The caller keeps the
/// memory, which another run of the same scene may go on from.
class EnergyGain {
 public:
  EnergyGain(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles);

  /// Records the energies of a frame. Frame 1 is ignored, as limits and contact may add energy in the first steps.
  void note_frame(int frame, const Energies& energies, EnergyGainMemory& memory) const;

  /// Describes the largest rise of the total energy between two frames, if it exceeds half of the largest kinetic energy and what
  /// step size, stretch limit and rounding explain. `positions` [m] give the size of rounding. Empty if the scene is driven:
  /// moving pins or obstacles, wind, or explicit Euler, which gains energy by itself.
  [[nodiscard]] std::optional<std::string> gain(const Points& positions, const EnergyGainMemory& memory) const;

 private:
  [[nodiscard]] double apparent_gain(const Points& positions, const EnergyGainMemory& memory) const;

  double mass_;           ///< [kg]
  double step_;           ///< [s]
  double gravity_;        ///< [m/s^2]
  double bounce_height_;  ///< length of the longest spring, with a stretch limit [m]
  bool undriven_;         ///< see gain()
};

}  // namespace sprung
