// The paths on which pins move their particles.
#pragma once

#include "collision/shapes/obstacle.h"
#include "collision/shapes/surface_anchor.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/pin.h"

#include <optional>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// The particles of a pin with a motion of its own, or which follows a rigid obstacle, move rigidly. Those of a pin that follows a
/// deforming obstacle each move with the triangle that was nearest when the pin began.
class PinPaths {
 public:
  /// Keeps references to both. Requires `register_pins` before all else. Throws InputError if a pin follows an obstacle that does
  /// not exist. `step_length` [s] is that of the simulation.
  PinPaths(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, double step_length);

  /// Records where pins that have begun, or that a program moves for the first time, have their particles, and drops the grips of
  /// other pins. Call it after pins or their motions changed. Returns whether anything is new.
  bool register_pins(SimulationState& state);

  /// Moves the particles to where they are at a time [s], and gives them the mean velocity of the following `dt` [s], which the
  /// dampers of their neighbours use. Returns the largest speed [m/s].
  double move(double time, double dt, SimulationState& state) const;

  /// Sets the mean velocities [m/s] of the particles in the `dt` [s] before a time, if their pins held them in it.
  void set_last_velocities(double time, double dt, Points& velocities) const;

 private:
  struct Held {
    Index particle;
    std::optional<double> begin;  ///< when the pin took the particle [s]; none: it moves from its position in the network
    Vector3 start;                ///< position then [m]
    SurfaceAnchor surface;        ///< on a deforming obstacle, in its frame
  };
  struct Path {
    const Pin* pin;
    std::vector<Index> held{};               ///< the particles that it holds
    const Obstacle* obstacle = nullptr;      ///< that the pin follows
    const MeshSequence* sequence = nullptr;  ///< of the obstacle, if it deforms
    std::vector<Held> particles{};

    [[nodiscard]] const Motion& motion() const { return obstacle != nullptr ? obstacle->motion : pin->motion; }
    [[nodiscard]] bool needs_grips() const { return pin->from > 0.0 || sequence != nullptr || !motion().poses.empty(); }
    [[nodiscard]] RigidTransform origin() const;
    [[nodiscard]] RigidTransform pose(double time) const;
  };
  class Placing;

  void find_paths();
  [[nodiscard]] static bool has_grips(const Path& path, const SimulationState& state);
  std::vector<PinGrip> grips_of(const Path& path, const SimulationState& state, bool& is_new) const;

  const SpringNetwork& network_;
  const std::vector<Obstacle>& obstacles_;
  double step_length_;
  std::vector<Path> paths_;
};

}  // namespace sprung
