#include "dynamics/stretch_kernel.h"

#include "base/kernel.h"
#include "dynamics/lanes.h"

#include <algorithm>

namespace sprung {
namespace {

struct LaneVectors {
  SpringLanes x;
  SpringLanes y;
  SpringLanes z;
};

[[gnu::always_inline]] inline void gather(const double* positions, const Index* particles, LaneVectors& to) {
  const double* p0 = positions + 3 * particles[0];
  const double* p1 = positions + 3 * particles[1];
  const double* p2 = positions + 3 * particles[2];
  const double* p3 = positions + 3 * particles[3];
  to.x = SpringLanes{p0[0], p1[0], p2[0], p3[0]};
  to.y = SpringLanes{p0[1], p1[1], p2[1], p3[1]};
  to.z = SpringLanes{p0[2], p1[2], p2[2], p3[2]};
}

[[gnu::always_inline]] inline void scatter(const LaneVectors& from, const Index* particles, double* positions) {
  for (Index lane = 0; lane < kSpringLanes; ++lane) {
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
  SpringLanes length;
  SpringLanes beyond;  ///< what the length has too much; negative when it is too short [m]
};

[[gnu::always_inline]] inline void measure(const StretchBatches& batches, Index s, const LengthRange& range,
                                           const double* positions, Measured& springs, SpringLanes& excess) {
  gather(positions, &batches.first[s], springs.first);
  gather(positions, &batches.second[s], springs.second);
  springs.between.x = springs.second.x - springs.first.x;
  springs.between.y = springs.second.y - springs.first.y;
  springs.between.z = springs.second.z - springs.first.z;
  const LaneVectors& d = springs.between;
  springs.length = d.x * d.x + d.y * d.y + d.z * d.z;
  square_root(springs.length);

  SpringLanes rest_length;
  load_lanes(&batches.rest_length[s], rest_length);
  const SpringLanes most = range.most * rest_length;
  const SpringLanes least = range.least * rest_length;
  const SpringLanes too_long = springs.length - most;
  const SpringLanes too_short = springs.length - least;
  springs.beyond = too_long > 0.0 ? too_long : (too_short < 0.0 ? too_short : SpringLanes{});
  const SpringLanes size = springs.beyond < 0.0 ? -springs.beyond : springs.beyond;
  const SpringLanes part = size / rest_length;
  excess = part > excess ? part : excess;
}

// A spring without length has no direction to be projected along: it stays.
[[gnu::always_inline]] inline void project(const StretchBatches& batches, Index s, Measured& springs, double* positions) {
  SpringLanes first_share;
  load_lanes(&batches.first_share[s], first_share);
  const SpringLanes quotient = springs.beyond / springs.length;
  const SpringLanes part = springs.length > 0.0 ? quotient : SpringLanes{};
  const SpringLanes of_first = first_share * part;
  const SpringLanes of_second = (1.0 - first_share) * part;
  springs.first.x += of_first * springs.between.x;
  springs.first.y += of_first * springs.between.y;
  springs.first.z += of_first * springs.between.z;
  springs.second.x -= of_second * springs.between.x;
  springs.second.y -= of_second * springs.between.y;
  springs.second.z -= of_second * springs.between.z;
  scatter(springs.first, &batches.first[s], positions);
  scatter(springs.second, &batches.second[s], positions);
}

[[gnu::always_inline]] inline double largest(const SpringLanes& of) {
  return std::max(std::max(of[0], of[1]), std::max(of[2], of[3]));
}

}  // namespace

SPRUNG_KERNEL
double project_springs(const StretchBatches& batches, Index begin, Index end, const LengthRange& range, double* positions) {
  SpringLanes excess{};
  for (Index s = begin; s < end; s += kSpringLanes) {
    Measured springs;
    measure(batches, s, range, positions, springs, excess);
    project(batches, s, springs, positions);
  }
  return largest(excess);
}

SPRUNG_KERNEL
double measure_springs(const StretchBatches& batches, Index begin, Index end, const LengthRange& range, const double* positions) {
  SpringLanes excess{};
  for (Index s = begin; s < end; s += kSpringLanes) {
    Measured springs;
    measure(batches, s, range, positions, springs, excess);
  }
  return largest(excess);
}

}  // namespace sprung
