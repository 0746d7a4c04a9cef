// Tells a simulation whose energy explodes: none of what drives it could have put so much in.
#pragma once

#include "collision/shapes/obstacle.h"
#include "simulation/settings/simulator_settings.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// What a state holds [J].
struct Energies {
  double kinetic = 0.0;
  double elastic = 0.0;
  double gravity = 0.0;
};

class EnergyWatch {
 public:
  /// Does not watch scenes with obstacles that push by forces, which it does not know.
  EnergyWatch(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles);

  [[nodiscard]] bool watches() const { return watches_; }

  /// Takes in the energies after a step; of the first two, 0 and 1, both count as what the scene begins with: limits and contact
  /// may give a start of their own. What springs hold while next to nothing has moved so far was put in slowly, by pins or
  /// obstacles: nothing that blows up is still.
  void note(std::int64_t step, const Energies& energies);

  /// Takes in the speed [m/s] of a pin.
  void note_pin(double speed) { fastest_drive_ = std::max(fastest_drive_, speed); }

  /// Takes in the speed [m/s] with which an obstacle may hit. What bounces to and fro between two that close in at that speed v is
  /// sped up to v (1 + e) / (1 - e), with restitution e: each bounce makes e (u + v) + v of its speed u. A wedge that closes drives
  /// out what is in it faster too, by 1 / tan of its angle: up to 32 times, at 2 degrees.
  void note_obstacle(double speed) {
    if (speed > 0.0) fastest_drive_ = std::max(fastest_drive_, bounce_gain_ * speed);
  }

  /// What is wrong with the energies, when motion and springs hold more than 1,000 times the sum of what they began with, what
  /// gravity has set free since, what was put in slowly, the motion of all particles as fast as the fastest pin, the wind or what
  /// obstacles hit, what it takes to stretch every spring to twice its length and fold every angle, and, where a limit holds
  /// lengths, to lift all by the length of a spring; and what rounding may move.
  [[nodiscard]] std::optional<std::string> explosion(const Energies& energies) const;

 private:
  [[nodiscard]] double put_in(const Energies& energies) const;

  double mass_;  ///< [kg]
  bool watches_;
  double bounce_gain_;    ///< of speed, by obstacles that move
  double fastest_drive_;  ///< [m/s]
  double capacity_;       ///< what springs, angles and limits hold [J]
  double start_ = 0.0;    ///< [J]
  double highest_ = 0.0;  ///< of the energies of gravity [J]
  double stored_ = 0.0;   ///< by springs, slowly [J]
  double most_kinetic_ = 0.0;
};

}  // namespace sprung
