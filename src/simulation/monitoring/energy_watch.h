// Watches the energy of a simulation: detects an explosion, and a gain that nothing drives.
#pragma once

#include "collision/shapes/obstacle.h"
#include "dynamics/forces/force.h"
#include "simulation/settings/simulator_settings.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// Energies of a state [J].
struct Energies {
  double kinetic = 0.0;
  double elastic = 0.0;
  double gravity = 0.0;
  double contact = 0.0;  ///< of penalty springs

  [[nodiscard]] double of_springs() const { return elastic + contact; }
};

/// Answers two questions. explosion(): does the state have more energy than anything can have supplied? It looks at steps and ends
/// the run. gain(): did the energy of an undriven scene rise between two frames? It looks at frames and gives a warning.
class EnergyWatch {
 public:
  /// Only explosion() needs the `forces`.
  EnergyWatch(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles,
              const Forces& forces);

  /// Records the energies after a step. Steps 0 and 1 both count as the start, as limits and contact may add energy in the first.
  /// Energy of springs counts as supplied by pins or obstacles while the kinetic energy so far is below 1 % of it: an explosion
  /// moves.
  void note(std::int64_t step, const Energies& energies);

  /// Records the speed [m/s] of a pin.
  void note_pin(double speed) { fastest_drive_ = std::max(fastest_drive_, speed); }

  /// Records the speed [m/s] at which an obstacle may hit a body. A body that bounces with restitution e between two obstacles that
  /// approach at speed v reaches v (1 + e) / (1 - e), as each bounce turns its speed u into e (u + v) + v. A closing wedge
  /// accelerates its content by 1 / tan(angle), taken as at most 32 (2 degrees).
  void note_obstacle(double speed) {
    if (speed > 0.0) fastest_drive_ = std::max(fastest_drive_, bounce_gain_ * speed);
  }

  /// Describes the explosion if the energies of motion and springs exceed 1,000 times the energy that can have been supplied. That
  /// is the sum of: the energy at the start; the potential energy released since; the energy supplied slowly (see note()); the
  /// kinetic energy of all particles at the speed of the fastest pin, wind or obstacle; the capacity of the
  /// forces (see Force::capacity); with a stretch limit, the energy to lift all particles by one spring length; and rounding.
  [[nodiscard]] std::optional<std::string> explosion(const Energies& energies) const;

  /// Records the energies of a frame. Frame 1 is ignored, as limits and contact may add energy in the first steps.
  void note_frame(int frame, const Energies& energies);

  /// Describes the largest rise of the total energy between two frames, if it exceeds half of the largest kinetic energy and what
  /// step size, stretch limit and rounding explain. `positions` [m] give the size of rounding. Empty if the scene is driven:
  /// moving pins or obstacles, wind, or explicit Euler, which gains energy by itself.
  [[nodiscard]] std::optional<std::string> gain(const Points& positions) const;

 private:
  struct FrameEnergy {
    int frame = 0;
    double energy = 0.0;  ///< [J]
  };

  [[nodiscard]] double supplied(const Energies& energies) const;
  [[nodiscard]] double apparent_gain(const Points& positions) const;

  double mass_;                        ///< [kg]
  double step_;                        ///< [s]
  double gravity_;                     ///< [m/s^2]
  double bounce_height_;               ///< length of the longest spring, with a stretch limit [m]
  bool undriven_;                      ///< see gain()
  double bounce_gain_;                 ///< factor on the speed of obstacles
  double fastest_drive_;               ///< [m/s]
  double capacity_;                    ///< of forces and limits [J]
  double start_ = 0.0;                 ///< [J]
  double highest_ = 0.0;               ///< largest potential energy of gravity [J]
  double stored_ = 0.0;                ///< energy of springs supplied slowly [J]
  double max_kinetic_ = 0.0;           ///< of steps [J]
  double max_frame_kinetic_ = 0.0;     ///< of frames [J]
  std::optional<FrameEnergy> lowest_;  ///< frame of the smallest total energy
  FrameEnergy rise_begin_;             ///< of the largest rise
  FrameEnergy rise_end_;
};

}  // namespace sprung
