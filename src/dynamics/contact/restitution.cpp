#include "dynamics/contact/restitution.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// An approach slower than this many times the speed that forces add in a step is rest, not an impact.
constexpr double kRestSteps = 2.0;

/// The speed towards the surface at which the parabola reaches the gap, or comes nearest to it.
double approach_speed(const FreeFlight& flight, double begin, double gain) {
  const double end = begin + gain;
  if (flight.height < 0.0) return std::max(0.0, -begin);
  if (flight.height + flight.moved >= 0.0) return std::max(0.0, -end);
  return std::sqrt(std::max(0.0, begin * begin - 2.0 * (gain / flight.dt) * flight.height));
}

}  // namespace

SpeedRange settled_speeds(const FreeFlight& flight, double restitution) {
  const double gain = flight.v_after - flight.v_before;
  const double mean = flight.moved / flight.dt;
  const double approach = approach_speed(flight, mean - 0.5 * gain, gain);
  const double bounce = restitution * approach;

  // A bounce that forces end within the step does not leave the surface.
  const bool impact = approach > kRestSteps * std::abs(gain) && bounce > -0.5 * gain;
  const double scheme_ahead = 0.5 * (flight.v_before + flight.v_after) - mean;
  const double least = impact ? std::max(0.0, bounce + scheme_ahead) : 0.0;
  return {.least = least, .most = std::max(least, flight.v_after)};
}

}  // namespace sprung
