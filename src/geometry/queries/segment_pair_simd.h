// Closest points of four pairs of segments. For the .cpp files of kernels.
#pragma once

#include "base/machine/simd.h"

namespace sprung {

struct SegmentLanes {
  Vector3x4 from;
  Vector3x4 to;
};

/// The closest points are from + s (to - from) and from + t (to - from).
struct SegmentPairLanes {
  Double4 s;                 ///< of the first segment
  Double4 t;                 ///< of the second segment
  Double4 squared_distance;  ///< [m^2]
};

namespace detail {

[[gnu::always_inline]] inline void clamp_to_segment(Double4& parameter) {
  const Double4 zero{};
  const Double4 one = zero + 1.0;
  parameter = parameter < zero ? zero : parameter;
  parameter = parameter > one ? one : parameter;
}

}  // namespace detail

/// Parameters and distances, to the last bit those of closest_points_of_segments. Returns the lanes with a segment of length 0,
/// which the caller must compute one by one.
[[nodiscard, gnu::always_inline]] inline unsigned closest_points(const SegmentLanes& a, const SegmentLanes& b,
                                                                 SegmentPairLanes& pairs) {
  const Double4 zero{};
  Vector3x4 along_a, along_b, between;
  subtract(a.to, a.from, along_a);
  subtract(b.to, b.from, along_b);
  subtract(a.from, b.from, between);
  Double4 aa, bb, ab, from_a, from_b;
  dot(along_a, along_a, aa);
  dot(along_b, along_b, bb);
  dot(along_a, along_b, ab);
  dot(along_a, between, from_a);
  dot(along_b, between, from_b);

  const Double4 sine2 = aa * bb - ab * ab;
  Double4 s = (ab * from_b - from_a * bb) / sine2;
  detail::clamp_to_segment(s);
  s = sine2 > 1e-14 * aa * bb ? s : zero;
  Double4 t = (ab * s + from_b) / bb;
  Double4 t_within = t;
  detail::clamp_to_segment(t_within);
  Double4 s_again = (t_within * ab - from_a) / aa;
  detail::clamp_to_segment(s_again);
  pairs.s = t == t_within ? s : s_again;
  pairs.t = t_within;

  Vector3x4 apart;
  apart.x = between.x + pairs.s * along_a.x - pairs.t * along_b.x;
  apart.y = between.y + pairs.s * along_a.y - pairs.t * along_b.y;
  apart.z = between.z + pairs.s * along_a.z - pairs.t * along_b.z;
  dot(apart, apart, pairs.squared_distance);
  const Mask4 is_point = (aa == zero) | (bb == zero);  // a named type, because clang gives the comparison another type
  return mask_bits(is_point);
}

}  // namespace sprung
