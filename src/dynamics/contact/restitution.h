// How fast a contact leaves: restitution at the moment of impact, whenever within the step that is.
#pragma once

namespace sprung {

/// The way of a contact through a step by forces alone, along its normal and relative to what it meets.
struct FreeFlight {
  double height = 0.0;    ///< above the gap at the step's begin [m]
  double moved = 0.0;     ///< during the step [m]
  double v_before = 0.0;  ///< the scheme's velocity at the step's begin [m/s]
  double v_after = 0.0;   ///< and at its end
  double dt = 0.0;        ///< [s]
};

/// Bounds of the velocity along the normal with which the scheme goes on [m/s].
struct SpeedRange {
  double least = 0.0;
  double most = 0.0;
};

/// At least restitution times the speed of the impact, or 0 when that is no more than what the forces make in a step or two (rest);
/// at most that, or what the forces alone would have made.
///
/// Under a constant force each of our schemes visits points of the exact parabola, whose speed is the scheme's half a step away
/// from the position: half a step later for symplectic Euler and Verlet, half a step earlier for explicit Euler. The speed of the
/// impact and that of the bounce are the parabola's own, so the height e^2 h of a bounce does not depend on the step.
[[nodiscard]] SpeedRange settled_speeds(const FreeFlight& flight, double restitution);

}  // namespace sprung
