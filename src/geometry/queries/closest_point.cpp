#include "geometry/queries/closest_point.h"

#include <algorithm>

namespace sprung {

namespace {

ClosestPoint at(const Vector3& p, const Vector3& point, TriangleFeature feature) {
  return {point, (p - point).squaredNorm(), feature};
}

/// The closest point on the three edges, for a triangle so thin that rounding prevents a closest point inside.
ClosestPoint closest_on_edges(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3* corners[] = {&a, &b, &c};
  ClosestPoint best = at(p, a, TriangleFeature::vertex0);
  for (int k = 0; k < 3; ++k) {
    const Vector3& from = *corners[k];
    const Vector3& to = *corners[(k + 1) % 3];
    const Vector3 along = to - from;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp(along.dot(p - from) / length2, 0.0, 1.0) : 0.0;
    const int feature = t <= 0.0 ? k : t >= 1.0 ? (k + 1) % 3 : 3 + k;
    const ClosestPoint found = at(p, t >= 1.0 ? to : Vector3(from + t * along), static_cast<TriangleFeature>(feature));
    if (found.squared_distance < best.squared_distance) best = found;
  }
  return best;
}

}  // namespace

ClosestPoint closest_point_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const Vector3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return at(p, a, TriangleFeature::vertex0);

  const Vector3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return at(p, b, TriangleFeature::vertex1);

  // d1 > d3 and d2 > d6 avoid divisions by zero for edges without length.
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) return at(p, a + d1 / (d1 - d3) * ab, TriangleFeature::edge01);

  const Vector3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return at(p, c, TriangleFeature::vertex2);

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) return at(p, a + d2 / (d2 - d6) * ac, TriangleFeature::edge20);

  const double va = d3 * d6 - d5 * d4;
  const double along_bc = d4 - d3;
  const double along_cb = d5 - d6;
  if (va <= 0.0 && along_bc >= 0.0 && along_cb >= 0.0 && along_bc + along_cb > 0.0) {
    return at(p, b + along_bc / (along_bc + along_cb) * (c - b), TriangleFeature::edge12);
  }

  // va + vb + vc is the squared area of the parallelogram. If its sine at corner a is below 1e-5, rounding of the products above
  // (1e-16 of |ab|^2 |ac|^2 and more) could shift the point along the thin triangle by 1e-6 of its length and more.
  const double area2 = va + vb + vc;
  if (!(area2 > 1e-10 * ab.squaredNorm() * ac.squaredNorm())) return closest_on_edges(p, a, b, c);
  return at(p, a + vb / area2 * ab + vc / area2 * ac, TriangleFeature::face);
}

}  // namespace sprung
