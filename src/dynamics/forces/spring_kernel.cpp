#include "dynamics/forces/spring_kernel.h"

#include "base/machine/kernel.h"
#include "dynamics/numerics/simd_packed.h"

namespace sprung {
namespace {

[[gnu::always_inline]] inline void load_difference(const double* a, const double* b, PackedVectors4& to) {
  PackedVectors4 of_a;
  PackedVectors4 of_b;
  load(a, of_a);
  load(b, of_b);
  subtract(of_a, of_b, to);
}

// F = scale * s, which is eq. 10 with one division: scale = -(k_s (|s| - d) + k_d (s . v) / |s|) / |s|. Where |s| = 0 any finite
// scale gives no force.
template <bool tension_only>
[[gnu::always_inline]] inline void to_force(PackedVectors4& difference, const PackedVectors4& velocity,
                                            const SpringConstants& constants, Index i) {
  Double4 x, y, z, v_x, v_y, v_z, rest_length, stiffness, damping;
  unpack(difference, x, y, z);
  unpack(velocity, v_x, v_y, v_z);
  load_simd(constants.rest_length.at(i), rest_length);
  load_simd(constants.stiffness.at(i), stiffness);
  load_simd(constants.damping.at(i), damping);
  Double4 length = x * x + y * y + z * z;
  square_root(length);
  const Double4 quotient = 1.0 / length;
  const Double4 inverse = length > 0.0 ? quotient : Double4{};
  const Double4 approach = (x * v_x + y * v_y + z * v_z) * inverse;
  Double4 scale = (stiffness * (rest_length - length) - damping * approach) * inverse;
  if constexpr (tension_only) scale = length > rest_length ? scale : Double4{};
  multiply(difference, scale);
}

// The last four springs may be computed twice. The two ends of a run may overlap, so all forces on one end are written before
// those on the other.
template <bool tension_only>
[[gnu::always_inline]] inline void add_forces(const SpringRun& run, const SpringConstants& constants) {
  double force[3 * kSpringBatch];
  for (Index next = 0; next < run.count; next += kSimdWidth) {
    const Index i = next + kSimdWidth <= run.count ? next : run.count - kSimdWidth;
    PackedVectors4 difference;
    PackedVectors4 velocity;
    load_difference(run.x_a + 3 * i, run.x_b + 3 * i, difference);
    load_difference(run.v_a + 3 * i, run.v_b + 3 * i, velocity);
    to_force<tension_only>(difference, velocity, constants, i);
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

template <bool tension_only>
[[gnu::always_inline]] inline void to_forces(double* difference, const double* velocity, Index count,
                                             const SpringConstants& constants) {
  for (Index i = 0; i < count; i += kSimdWidth) {
    PackedVectors4 s;
    PackedVectors4 v;
    load(difference + 3 * i, s);
    load(velocity + 3 * i, v);
    to_force<tension_only>(s, v, constants, i);
    store(s, difference + 3 * i);
  }
}

}  // namespace

SPRUNG_KERNEL
void add_run_forces(const SpringRun& run, const SpringConstants& constants) {
  if (constants.tension_only) {
    add_forces<true>(run, constants);
  } else {
    add_forces<false>(run, constants);
  }
}

SPRUNG_KERNEL
void differences_to_forces(double* difference, const double* velocity, Index count, const SpringConstants& constants) {
  if (constants.tension_only) {
    to_forces<true>(difference, velocity, count, constants);
  } else {
    to_forces<false>(difference, velocity, count, constants);
  }
}

}  // namespace sprung
