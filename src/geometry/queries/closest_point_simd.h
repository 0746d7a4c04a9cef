// Closest points of four triangles, each to its own query point. For the .cpp files of kernels.
#pragma once

#include "base/machine/simd.h"
#include "geometry/queries/closest_point.h"

namespace sprung {

struct TriangleLanes {
  Vector3x4 a;
  Vector3x4 b;
  Vector3x4 c;
};

/// The closest point is of_a a + of_b b + of_c c. The weight of a corner that does not contribute is exactly 0.
struct ClosestPointLanes {
  Vector3x4 point;
  Double4 of_a;
  Double4 of_b;
  Double4 of_c;
  Double4 squared_distance;  ///< [m^2]
};

namespace detail {

/// The closest point as base + (s along + t ac) / divisor.
struct Foot {
  Vector3x4 base;
  Vector3x4 along;
  Double4 s;
  Double4 t;
  Double4 divisor;
  Mask4 from_b;  ///< the base is b; if neither b nor c, it is a
  Mask4 from_c;  ///< the base is c
  Mask4 on_face;
};

enum class Base : std::uint8_t { a, b, c };

/// Moves the foot to an edge or a vertex in the lanes of `where`.
template <Base kBase>
[[gnu::always_inline]] inline void put(const Mask4& where, const Vector3x4& base, const Vector3x4& along, const Double4& s,
                                       const Double4& t, const Double4& divisor, Foot& foot) {
  foot.base.x = where ? base.x : foot.base.x;
  foot.base.y = where ? base.y : foot.base.y;
  foot.base.z = where ? base.z : foot.base.z;
  foot.along.x = where ? along.x : foot.along.x;
  foot.along.y = where ? along.y : foot.along.y;
  foot.along.z = where ? along.z : foot.along.z;
  foot.s = where ? s : foot.s;
  foot.t = where ? t : foot.t;
  foot.divisor = where ? divisor : foot.divisor;
  foot.from_b = kBase == Base::b ? foot.from_b | where : foot.from_b & ~where;
  foot.from_c = kBase == Base::c ? foot.from_c | where : foot.from_c & ~where;
  foot.on_face &= ~where;
}

}  // namespace detail

/// Points and distances, to the last bit those of closest_point_on_triangle. The cases are the same in reverse order: a later case
/// overwrites an earlier one. Returns the lanes whose triangles are so thin that the caller must compute them one by one.
[[nodiscard, gnu::always_inline]] inline unsigned closest_points(const Vector3x4& p, const TriangleLanes& triangles,
                                                                 ClosestPointLanes& closest) {
  using detail::Base;
  const auto& [a, b, c] = triangles;
  const Double4 zero{};
  const Double4 one = zero + 1.0;
  Vector3x4 ab, ac, bc, ap, bp, cp;
  subtract(b, a, ab);
  subtract(c, a, ac);
  subtract(c, b, bc);
  subtract(p, a, ap);
  subtract(p, b, bp);
  subtract(p, c, cp);
  Double4 d1, d2, d3, d4, d5, d6, ab2, ac2;
  dot(ab, ap, d1);
  dot(ac, ap, d2);
  dot(ab, bp, d3);
  dot(ac, bp, d4);
  dot(ab, cp, d5);
  dot(ac, cp, d6);
  dot(ab, ab, ab2);
  dot(ac, ac, ac2);
  const Double4 va = d3 * d6 - d5 * d4;
  const Double4 vb = d5 * d2 - d1 * d6;
  const Double4 vc = d1 * d4 - d3 * d2;
  const Double4 area2 = va + vb + vc;
  const Double4 along_bc = d4 - d3;
  const Double4 along_cb = d5 - d6;

  detail::Foot foot{a, ab, vb, vc, area2, {}, {}, Mask4{-1, -1, -1, -1}};
  detail::put<Base::b>((va <= zero) & (along_bc >= zero) & (along_cb >= zero) & (along_bc + along_cb > zero), b, bc, along_bc, zero,
                       along_bc + along_cb, foot);
  detail::put<Base::a>((vb <= zero) & (d2 >= zero) & (d6 <= zero) & (d2 > d6), a, ab, zero, d2, d2 - d6, foot);
  detail::put<Base::c>((d6 >= zero) & (d5 <= d6), c, ab, zero, zero, one, foot);
  detail::put<Base::a>((vc <= zero) & (d1 >= zero) & (d3 <= zero) & (d1 > d3), a, ab, d1, zero, d1 - d3, foot);
  detail::put<Base::b>((d3 >= zero) & (d4 <= d3), b, ab, zero, zero, one, foot);
  detail::put<Base::a>((d1 <= zero) & (d2 <= zero), a, ab, zero, zero, one, foot);

  const Double4 s = foot.s / foot.divisor;
  const Double4 t = foot.t / foot.divisor;
  closest.point.x = foot.base.x + s * foot.along.x + t * ac.x;
  closest.point.y = foot.base.y + s * foot.along.y + t * ac.y;
  closest.point.z = foot.base.z + s * foot.along.z + t * ac.z;
  const Double4 rest = one - s - t;
  closest.of_a = (foot.from_b | foot.from_c | (rest < zero)) ? zero : rest;
  closest.of_b = foot.from_b ? one - s : foot.from_c ? zero : s;
  closest.of_c = foot.from_b ? s : foot.from_c ? one : t;
  Vector3x4 away;
  subtract(p, closest.point, away);
  dot(away, away, closest.squared_distance);

  return mask_bits(foot.on_face & ~(area2 > 1e-10 * ab2 * ac2));
}

}  // namespace sprung
