#include "dynamics/tether_kernel.h"

#include "base/kernel.h"
#include "dynamics/packed_lanes.h"

#include <algorithm>

namespace sprung {
namespace {

/// One vector four times.
[[gnu::always_inline]] inline void repeat(const double* from, Packed& to) {
  to.low = SpringLanes{from[0], from[1], from[2], from[0]};
  to.middle = SpringLanes{from[1], from[2], from[0], from[1]};
  to.high = SpringLanes{from[2], from[0], from[1], from[2]};
}

/// Four tethers.
[[gnu::always_inline]] inline void project(const Packed& pins, const double* lengths, double* positions) {
  Packed particles;
  Packed beyond;
  SpringLanes x, y, z, most;
  load(positions, particles);
  subtract(particles, pins, beyond);
  unpack(beyond, x, y, z);
  load_lanes(lengths, most);
  const SpringLanes squared = x * x + y * y + z * z;
  const auto outside = squared > most * most;
  if ((outside[0] | outside[1] | outside[2] | outside[3]) == 0) return;
  SpringLanes length = squared;
  square_root(length);
  const SpringLanes quotient = (length - most) / length;
  multiply(beyond, outside ? quotient : SpringLanes{});
  subtract(particles, beyond, particles);
  store(particles, positions);
}

[[gnu::always_inline]] inline void project_one(const double* pin, double most, double* position) {
  const double x = position[0] - pin[0];
  const double y = position[1] - pin[1];
  const double z = position[2] - pin[2];
  const double squared = x * x + y * y + z * z;
  if (squared <= most * most) return;
  const double length = std::sqrt(squared);
  const double part = (length - most) / length;
  position[0] -= part * x;
  position[1] -= part * y;
  position[2] -= part * z;
}

}  // namespace

// The last four tethers of a run may be projected twice, which changes nothing but rounding.
SPRUNG_KERNEL
void project_tethers(const TetherRun& run, const double* lengths, double* positions) {
  const Index step = run.one_pin ? 0 : 1;
  if (run.count < kSpringLanes) {
    for (Index i = 0; i < run.count; ++i) {
      project_one(positions + 3 * (run.pin + i * step), lengths[run.tether + i], positions + 3 * (run.particle + i));
    }
    return;
  }
  Packed pins;
  repeat(positions + 3 * run.pin, pins);
  for (Index next = 0; next < run.count; next += kSpringLanes) {
    const Index i = std::min(next, run.count - kSpringLanes);
    if (!run.one_pin) load(positions + 3 * (run.pin + i), pins);
    project(pins, lengths + run.tether + i, positions + 3 * (run.particle + i));
  }
}

}  // namespace sprung
