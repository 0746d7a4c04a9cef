#include "dynamics/stretch_kernel.h"

#include "base/kernel.h"
#include "dynamics/lanes.h"

#include <algorithm>

namespace sprung {
namespace {

struct LaneVectors {
  Lanes x;
  Lanes y;
  Lanes z;
};

[[gnu::always_inline]] inline void gather(const double* positions, const Index* particles, LaneVectors& to) {
  const double* p0 = positions + 3 * particles[0];
  const double* p1 = positions + 3 * particles[1];
  const double* p2 = positions + 3 * particles[2];
  const double* p3 = positions + 3 * particles[3];
  to.x = Lanes{p0[0], p1[0], p2[0], p3[0]};
  to.y = Lanes{p0[1], p1[1], p2[1], p3[1]};
  to.z = Lanes{p0[2], p1[2], p2[2], p3[2]};
}

[[gnu::always_inline]] inline void scatter(const LaneVectors& from, const Index* particles, double* positions) {
  for (Index lane = 0; lane < kLanes; ++lane) {
    double* p = positions + 3 * particles[lane];
    p[0] = from.x[lane];
    p[1] = from.y[lane];
    p[2] = from.z[lane];
  }
}

/// Four springs and how far they are beyond their limits.
struct Measured {
  LaneVectors first;
  LaneVectors second;
  LaneVectors between;  ///< second - first
  Lanes length;
  Lanes beyond;  ///< what the length has too much; negative when it is too short [m]
};

[[gnu::always_inline]] inline void measure(const StretchBatches& batches, Index s, const LengthRange& range,
                                           const double* positions, Measured& springs, Lanes& excess) {
  gather(positions, &batches.first[s], springs.first);
  gather(positions, &batches.second[s], springs.second);
  springs.between.x = springs.second.x - springs.first.x;
  springs.between.y = springs.second.y - springs.first.y;
  springs.between.z = springs.second.z - springs.first.z;
  const LaneVectors& d = springs.between;
  springs.length = d.x * d.x + d.y * d.y + d.z * d.z;
  square_root(springs.length);

  Lanes rest_length;
  load_lanes(&batches.rest_length[s], rest_length);
  const Lanes most = range.most * rest_length;
  const Lanes least = range.least * rest_length;
  const Lanes too_long = springs.length - most;
  const Lanes too_short = springs.length - least;
  springs.beyond = too_long > 0.0 ? too_long : (too_short < 0.0 ? too_short : Lanes{});
  const Lanes size = springs.beyond < 0.0 ? -springs.beyond : springs.beyond;
  const Lanes part = size / rest_length;
  excess = part > excess ? part : excess;
}

// A spring without length has no direction to be projected along: it stays.
[[gnu::always_inline]] inline void project(const StretchBatches& batches, Index s, Measured& springs, double* positions) {
  Lanes first_share;
  load_lanes(&batches.first_share[s], first_share);
  const Lanes quotient = springs.beyond / springs.length;
  const Lanes part = springs.length > 0.0 ? quotient : Lanes{};
  const Lanes of_first = first_share * part;
  const Lanes of_second = (1.0 - first_share) * part;
  springs.first.x += of_first * springs.between.x;
  springs.first.y += of_first * springs.between.y;
  springs.first.z += of_first * springs.between.z;
  springs.second.x -= of_second * springs.between.x;
  springs.second.y -= of_second * springs.between.y;
  springs.second.z -= of_second * springs.between.z;
  scatter(springs.first, &batches.first[s], positions);
  scatter(springs.second, &batches.second[s], positions);
}

[[gnu::always_inline]] inline double largest(const Lanes& of) { return std::max(std::max(of[0], of[1]), std::max(of[2], of[3])); }

}  // namespace

SPRUNG_KERNEL
double project_springs(const StretchBatches& batches, Index begin, Index end, const LengthRange& range, double* positions) {
  Lanes excess{};
  for (Index s = begin; s < end; s += kLanes) {
    Measured springs;
    measure(batches, s, range, positions, springs, excess);
    project(batches, s, springs, positions);
  }
  return largest(excess);
}

SPRUNG_KERNEL
double measure_springs(const StretchBatches& batches, Index begin, Index end, const LengthRange& range, const double* positions) {
  Lanes excess{};
  for (Index s = begin; s < end; s += kLanes) {
    Measured springs;
    measure(batches, s, range, positions, springs, excess);
  }
  return largest(excess);
}

}  // namespace sprung
