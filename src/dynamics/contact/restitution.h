// The speed of a contact after an impact, which may happen at any time within the step.
#pragma once

namespace sprung {

/// The motion of a contact in a step by forces alone, along its normal and relative to the touched surface.
struct FreeFlight {
  double height = 0.0;    ///< above the gap at the beginning of the step [m]
  double moved = 0.0;     ///< during the step [m]
  double v_before = 0.0;  ///< the scheme's velocity at the beginning of the step [m/s]
  double v_after = 0.0;   ///< at its end [m/s]
  double dt = 0.0;        ///< [s]
};

/// Bounds of the velocity along the normal after the step [m/s].
struct SpeedRange {
  double least = 0.0;
  double most = 0.0;
};

/// The lower bound is restitution times the impact speed, or 0 where that is no more than forces add in one or two steps (rest).
/// The upper bound is the larger of that and of the speed by forces alone.
///
/// Under a constant force each scheme visits points of the exact parabola. Its velocity is the parabola's half a step away: half a
/// step later for symplectic Euler and Verlet, half a step earlier for explicit Euler. Impact and bounce use the parabola's own
/// speeds, so the height e^2 h of a bounce does not depend on the step.
[[nodiscard]] SpeedRange settled_speeds(const FreeFlight& flight, double restitution);

}  // namespace sprung
