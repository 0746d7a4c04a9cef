#include "dynamics/spring_kernel.h"

#include "base/kernel.h"
#include "dynamics/lanes.h"

namespace sprung {
namespace {

// The compiler vectorises loops over x, y, z by itself too, but shuffles three times as much, and shuffles are what such loops wait
// for.

/// Four vectors as they lie in memory.
struct Packed {
  SpringLanes low;     ///< x0 y0 z0 x1
  SpringLanes middle;  ///< y1 z1 x2 y2
  SpringLanes high;    ///< z2 x3 y3 z3
};

[[gnu::always_inline]] inline void load(const double* from, Packed& to) {
  load_lanes(from, to.low);
  load_lanes(from + kSpringLanes, to.middle);
  load_lanes(from + 2 * kSpringLanes, to.high);
}

[[gnu::always_inline]] inline void store(const Packed& from, double* to) {
  store_lanes(from.low, to);
  store_lanes(from.middle, to + kSpringLanes);
  store_lanes(from.high, to + 2 * kSpringLanes);
}

[[gnu::always_inline]] inline void load_difference(const double* a, const double* b, Packed& to) {
  Packed of_b;
  load(a, to);
  load(b, of_b);
  to.low -= of_b.low;
  to.middle -= of_b.middle;
  to.high -= of_b.high;
}

[[gnu::always_inline]] inline void unpack(const Packed& from, SpringLanes& x, SpringLanes& y, SpringLanes& z) {
  const SpringLanes xy = __builtin_shufflevector(from.low, from.middle, 0, 1, 6, 7);   // x0 y0 x2 y2
  const SpringLanes zx = __builtin_shufflevector(from.low, from.high, 2, 3, 4, 5);     // z0 x1 z2 x3
  const SpringLanes yz = __builtin_shufflevector(from.middle, from.high, 0, 1, 6, 7);  // y1 z1 y3 z3
  x = __builtin_shufflevector(xy, zx, 0, 5, 2, 7);
  y = __builtin_shufflevector(xy, yz, 1, 4, 3, 6);
  z = __builtin_shufflevector(zx, yz, 0, 5, 2, 7);
}

[[gnu::always_inline]] inline void multiply(Packed& vectors, const SpringLanes& scale) {
  vectors.low *= __builtin_shufflevector(scale, scale, 0, 0, 0, 1);
  vectors.middle *= __builtin_shufflevector(scale, scale, 1, 1, 2, 2);
  vectors.high *= __builtin_shufflevector(scale, scale, 2, 3, 3, 3);
}

// F = scale * s, which is eq. 10 with one division: scale = -(k_s (|s| - d) + k_d (s . v) / |s|) / |s|. Where |s| = 0 any finite
// scale gives no force.
[[gnu::always_inline]] inline void to_force(Packed& difference, const Packed& velocity, const SpringConstants& constants, Index i) {
  SpringLanes x, y, z, v_x, v_y, v_z, rest_length, stiffness, damping;
  unpack(difference, x, y, z);
  unpack(velocity, v_x, v_y, v_z);
  load_lanes(constants.rest_length.at(i), rest_length);
  load_lanes(constants.stiffness.at(i), stiffness);
  load_lanes(constants.damping.at(i), damping);
  SpringLanes length = x * x + y * y + z * z;
  square_root(length);
  const SpringLanes quotient = 1.0 / length;
  const SpringLanes inverse = length > 0.0 ? quotient : SpringLanes{};
  const SpringLanes approach = (x * v_x + y * v_y + z * v_z) * inverse;
  const SpringLanes scale = (stiffness * (rest_length - length) - damping * approach) * inverse;
  multiply(difference, scale);
}

}  // namespace

// The last four springs may be computed twice. The ends of a run may overlap, so all of the one are written before any of the
// other.
SPRUNG_KERNEL
void add_run_forces(const SpringRun& run, const SpringConstants& constants) {
  double force[3 * kSpringBatch];
  for (Index next = 0; next < run.count; next += kSpringLanes) {
    const Index i = next + kSpringLanes <= run.count ? next : run.count - kSpringLanes;
    Packed difference;
    Packed velocity;
    load_difference(run.x_a + 3 * i, run.x_b + 3 * i, difference);
    load_difference(run.v_a + 3 * i, run.v_b + 3 * i, velocity);
    to_force(difference, velocity, constants, i);
    store(difference, force + 3 * i);
  }
  const Index count = 3 * run.count;
  if (run.force_a != nullptr) {
    for (Index i = 0; i < count; ++i) run.force_a[i] += force[i];
  }
  if (run.force_b != nullptr) {
    for (Index i = 0; i < count; ++i) run.force_b[i] -= force[i];
  }
}

SPRUNG_KERNEL
void differences_to_forces(double* difference, const double* velocity, Index count, const SpringConstants& constants) {
  for (Index i = 0; i < count; i += kSpringLanes) {
    Packed s;
    Packed v;
    load(difference + 3 * i, s);
    load(velocity + 3 * i, v);
    to_force(s, v, constants, i);
    store(s, difference + 3 * i);
  }
}

}  // namespace sprung
