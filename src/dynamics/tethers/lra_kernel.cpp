#include "dynamics/tethers/lra_kernel.h"

#include "dynamics/numerics/simd_packed.h"

#include <algorithm>

namespace sprung {
namespace {

/// Repeats one vector in all lanes.
[[gnu::always_inline]] inline void repeat(const double* from, PackedVectors4& to) {
  to.low = Double4{from[0], from[1], from[2], from[0]};
  to.middle = Double4{from[1], from[2], from[0], from[1]};
  to.high = Double4{from[2], from[0], from[1], from[2]};
}

[[gnu::always_inline]] inline void repeat(const double* from, PackedVectors8& to) {
  to.low = Double8{from[0], from[1], from[2], from[0], from[1], from[2], from[0], from[1]};
  to.middle = Double8{from[2], from[0], from[1], from[2], from[0], from[1], from[2], from[0]};
  to.high = Double8{from[1], from[2], from[0], from[1], from[2], from[0], from[1], from[2]};
}

/// Projects a register of tethers, of which some are active.
template <class PackedVectors4>
[[gnu::always_inline]] inline void project(const PackedVectors4& pins, const double* lengths, double* positions) {
  using Lanes = typename PackedVectors4::Lanes;
  PackedVectors4 particles;
  PackedVectors4 beyond;
  Lanes x, y, z, most, inverse;
  load(positions, particles);
  subtract(particles, pins, beyond);
  unpack(beyond, x, y, z);
  load_simd(lengths, most);
  const Lanes squared = x * x + y * y + z * z;
  if (!any_above(squared, most * most)) return;
  inverse_root(squared, inverse);
  multiply(beyond, squared > most * most ? 1.0 - most * inverse : Lanes{});
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
  const double fraction = (length - most) / length;
  position[0] -= fraction * x;
  position[1] -= fraction * y;
  position[2] -= fraction * z;
}

/// Projects the tethers of a run from `begin` on while they fill a register. Returns the first that does not.
template <class PackedVectors4>
[[gnu::always_inline]] inline Index project_whole(const LraRun& run, Index begin, const double* lengths, double* positions) {
  constexpr Index kCount = kCountOf<typename PackedVectors4::Lanes>;
  PackedVectors4 pins;
  repeat(positions + 3 * run.pin, pins);
  Index i = begin;
  for (; i + kCount <= run.count; i += kCount) {
    if (!run.one_pin) load(positions + 3 * (run.pin + i), pins);
    project(pins, lengths + run.tether + i, positions + 3 * (run.particle + i));
  }
  return i;
}

// The last four tethers of a run may be projected twice, which changes rounding only.
template <class Widest>
[[gnu::always_inline]] inline void project_run(const LraRun& run, const double* lengths, double* positions) {
  const Index wide = project_whole<Widest>(run, 0, lengths, positions);
  const Index whole = project_whole<PackedVectors4>(run, wide, lengths, positions);
  if (whole == run.count) return;
  if (run.count >= kSimdWidth) {
    project_whole<PackedVectors4>(run, run.count - kSimdWidth, lengths, positions);
    return;
  }
  const Index step = run.one_pin ? 0 : 1;
  for (Index i = 0; i < run.count; ++i) {
    project_one(positions + 3 * (run.pin + i * step), lengths[run.tether + i], positions + 3 * (run.particle + i));
  }
}

}  // namespace

SPRUNG_KERNEL
void project_tethers_narrow(const LraRun& run, const double* lengths, double* positions) {
  project_run<PackedVectors4>(run, lengths, positions);
}

SPRUNG_WIDE_KERNEL
void project_tethers_wide(const LraRun& run, const double* lengths, double* positions) {
  project_run<PackedVectors8>(run, lengths, positions);
}

}  // namespace sprung
