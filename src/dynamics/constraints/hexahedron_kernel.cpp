#include "dynamics/constraints/hexahedron_kernel.h"

#include "base/machine/kernel.h"
#include "base/machine/simd.h"

#include <cmath>

namespace sprung {
namespace {

constexpr std::size_t kCorners = kCornersOfHexahedron;

// Where no corner can move, the sum is 0; a quotient by this number, times a mass or a gradient of 0, is 0.
constexpr double kLeastSum = 1.0e-100;

template <class Lanes>
struct LaneVector {
  Lanes x, y, z;
};

// Eigen sums three products in this order.
template <class Lanes>
[[gnu::always_inline]] inline void dot(const LaneVector<Lanes>& a, const LaneVector<Lanes>& b, Lanes& sum) {
  sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <class Lanes>
[[gnu::always_inline]] inline void cross(const LaneVector<Lanes>& a, const LaneVector<Lanes>& b, LaneVector<Lanes>& product) {
  product.x = a.y * b.z - a.z * b.y;
  product.y = a.z * b.x - a.x * b.z;
  product.z = a.x * b.y - a.y * b.x;
}

template <class Lanes>
[[gnu::always_inline]] inline void subtract(const LaneVector<Lanes>& a, const LaneVector<Lanes>& b, LaneVector<Lanes>& difference) {
  difference = {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Lanes>
[[gnu::always_inline]] inline void add(const LaneVector<Lanes>& more, LaneVector<Lanes>& sum) {
  sum = {sum.x + more.x, sum.y + more.y, sum.z + more.z};
}

template <class Lanes>
[[gnu::always_inline]] inline void load_corner(const double* positions, const Index* particles, LaneVector<Lanes>& corner) {
  for (Index lane = 0; lane < kCountOf<Lanes>; ++lane) {
    const double* const x = positions + 3 * std::ptrdiff_t{particles[lane]};
    corner.x[lane] = x[0];
    corner.y[lane] = x[1];
    corner.z[lane] = x[2];
  }
}

template <class Lanes>
[[gnu::always_inline]] inline void store_corner(const LaneVector<Lanes>& corner, const Index* particles, double* positions) {
  for (Index lane = 0; lane < kCountOf<Lanes>; ++lane) {
    double* const x = positions + 3 * std::ptrdiff_t{particles[lane]};
    x[0] = corner.x[lane];
    x[1] = corner.y[lane];
    x[2] = corner.z[lane];
  }
}

template <class Lanes>
[[gnu::always_inline]] inline void load_masses(const double* inverse_masses, const Index* particles, Lanes& masses) {
  double gathered[kCountOf<Lanes>];
  for (Index lane = 0; lane < kCountOf<Lanes>; ++lane) gathered[lane] = inverse_masses[particles[lane]];
  load_simd(gathered, masses);
}

template <class Lanes>
[[gnu::always_inline]] inline void keep_smaller(const Lanes& value, Lanes& smallest) {
  smallest = value < smallest ? value : smallest;
}

/// From the first corner of a part to the others.
template <class Lanes>
[[gnu::always_inline]] inline void find_edges(const std::array<int, 4>& part, const LaneVector<Lanes>* corners,
                                              LaneVector<Lanes>& a, LaneVector<Lanes>& b, LaneVector<Lanes>& c) {
  subtract(corners[part[1]], corners[part[0]], a);
  subtract(corners[part[2]], corners[part[0]], b);
  subtract(corners[part[3]], corners[part[0]], c);
}

/// Adds the volume of a part and its gradients.
template <class Lanes>
[[gnu::always_inline]] inline void add_part(const std::array<int, 4>& part, const LaneVector<Lanes>* corners, Lanes& volume,
                                            LaneVector<Lanes>* gradients) {
  LaneVector<Lanes> a;
  LaneVector<Lanes> b;
  LaneVector<Lanes> c;
  find_edges(part, corners, a, b, c);
  LaneVector<Lanes> of_a;
  LaneVector<Lanes> of_b;
  LaneVector<Lanes> of_c;
  cross(b, c, of_a);
  cross(c, a, of_b);
  cross(a, b, of_c);
  LaneVector<Lanes> sum = of_a;
  add(of_b, sum);
  add(of_c, sum);
  subtract(gradients[part[0]], sum, gradients[part[0]]);
  add(of_a, gradients[part[1]]);
  add(of_b, gradients[part[2]]);
  add(of_c, gradients[part[3]]);
  dot(a, of_a, volume);
}

template <class Lanes>
[[gnu::always_inline]] inline void load_corners(const HexahedronGroup& group, std::size_t first, const double* positions,
                                                LaneVector<Lanes>* corners) {
#pragma GCC unroll 8
  for (std::size_t c = 0; c < kCorners; ++c) load_corner(positions, &group.particles[c][first], corners[c]);
}

/// The volume of a part without gradients.
template <class Lanes>
[[gnu::always_inline]] inline void find_part(const std::array<int, 4>& part, const LaneVector<Lanes>* corners, Lanes& volume) {
  LaneVector<Lanes> a;
  LaneVector<Lanes> b;
  LaneVector<Lanes> c;
  find_edges(part, corners, a, b, c);
  LaneVector<Lanes> of_a;
  cross(b, c, of_a);
  dot(a, of_a, volume);
}

template <class Lanes>
[[gnu::always_inline]] inline void measure_lanes(const HexahedronGroup& group, std::size_t first, const double* positions,
                                                 HexahedraVolumes& found) {
  LaneVector<Lanes> corners[kCorners]{};
  load_corners(group, first, positions, corners);
  Lanes volume{};
  Lanes least = Lanes{} + HUGE_VAL;
#pragma GCC unroll 10
  for (std::size_t p = 0; p < kTetrahedraOfHexahedron.size(); ++p) {
    Lanes of_part;
    find_part(kTetrahedraOfHexahedron[p], corners, of_part);
    volume += of_part;
    if (p < kCornersOfHexahedron) keep_smaller(of_part, least);
  }
  store_simd(volume, &found.total[first]);
  store_simd(least, &found.least[first]);
}

/// The lanes [first, first + kCountOf<Lanes>) of a group.
template <class Lanes>
[[gnu::always_inline]] inline void project_lanes(const HexahedronGroup& group, std::size_t first, const double* inverse_masses,
                                                 double* positions, HexahedraFound& found) {
  LaneVector<Lanes> corners[kCorners]{};
  LaneVector<Lanes> gradients[kCorners]{};
  load_corners(group, first, positions, corners);
  Lanes volume{};
  Lanes least = Lanes{} + HUGE_VAL;
  Lanes slack = least;
#pragma GCC unroll 10
  for (std::size_t p = 0; p < kTetrahedraOfHexahedron.size(); ++p) {
    Lanes of_part;
    add_part(kTetrahedraOfHexahedron[p], corners, of_part, gradients);
    volume += of_part;
    if (p >= kCornersOfHexahedron) continue;
    Lanes watched;
    load_simd(&group.watched[p][first], watched);
    keep_smaller(of_part, least);
    keep_smaller(of_part - watched, slack);
  }
  Lanes sum{};
  Lanes masses[kCorners];
#pragma GCC unroll 8
  for (std::size_t c = 0; c < kCorners; ++c) {
    load_masses(inverse_masses, &group.particles[c][first], masses[c]);
    Lanes squared;
    dot(gradients[c], gradients[c], squared);
    sum += masses[c] * squared;
  }
  Lanes rest;
  load_simd(&group.volume[first], rest);
  sum = sum > kLeastSum ? sum : Lanes{} + kLeastSum;
  const Lanes scale = (rest - volume) / sum;
#pragma GCC unroll 8
  for (std::size_t c = 0; c < kCorners; ++c) {
    const Lanes by = scale * masses[c];
    corners[c] = {corners[c].x + by * gradients[c].x, corners[c].y + by * gradients[c].y, corners[c].z + by * gradients[c].z};
    store_corner(corners[c], &group.particles[c][first], positions);
  }
  store_simd(volume, &found.volumes.total[first]);
  store_simd(least, &found.volumes.least[first]);
  store_simd(slack, &found.slack[first]);
}

template <class Lanes>
[[gnu::always_inline]] inline void project_groups(std::span<const HexahedronGroup> groups, const double* inverse_masses,
                                                  double* positions, HexahedraFound* found) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t first = 0; first < kHexahedraPerGroup; first += kCountOf<Lanes>) {
      project_lanes<Lanes>(groups[g], first, inverse_masses, positions, found[g]);
    }
  }
}

template <class Lanes>
[[gnu::always_inline]] inline void measure_groups(std::span<const HexahedronGroup> groups, const double* positions,
                                                  HexahedraVolumes* found) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t first = 0; first < kHexahedraPerGroup; first += kCountOf<Lanes>) {
      measure_lanes<Lanes>(groups[g], first, positions, found[g]);
    }
  }
}

SPRUNG_KERNEL
void project_narrow(std::span<const HexahedronGroup> groups, const double* inverse_masses, double* positions,
                    HexahedraFound* found) {
  project_groups<Double4>(groups, inverse_masses, positions, found);
}

SPRUNG_WIDE_KERNEL
void project_wide(std::span<const HexahedronGroup> groups, const double* inverse_masses, double* positions, HexahedraFound* found) {
  project_groups<Double8>(groups, inverse_masses, positions, found);
}

SPRUNG_KERNEL
void measure_narrow(std::span<const HexahedronGroup> groups, const double* positions, HexahedraVolumes* found) {
  measure_groups<Double4>(groups, positions, found);
}

SPRUNG_WIDE_KERNEL
void measure_wide(std::span<const HexahedronGroup> groups, const double* positions, HexahedraVolumes* found) {
  measure_groups<Double8>(groups, positions, found);
}

}  // namespace

void project_hexahedra(std::span<const HexahedronGroup> groups, const double* inverse_masses, double* positions,
                       HexahedraFound* found) {
  static const bool kWide = has_wide_lanes();
  (kWide ? &project_wide : &project_narrow)(groups, inverse_masses, positions, found);
}

void measure_hexahedra(std::span<const HexahedronGroup> groups, const double* positions, HexahedraVolumes* found) {
  static const bool kWide = has_wide_lanes();
  (kWide ? &measure_wide : &measure_narrow)(groups, positions, found);
}

}  // namespace sprung
