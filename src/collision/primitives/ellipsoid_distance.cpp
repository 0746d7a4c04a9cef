#include "collision/primitives/primitive_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung {

namespace {

/// The sum of (z_i / (u + gap_i))^2 minus 1, and its derivative. Terms with z_i = 0 vanish, even at their pole.
struct Secular {
  double value = -1.0;
  double slope = 0.0;
};

Secular secular(const Vector3& z, const Vector3& gap, double u) {
  Secular sum;
  for (int i = 0; i < 3; ++i) {
    if (z[i] == 0.0) continue;
    const double ratio = z[i] / (u + gap[i]);
    sum.value += ratio * ratio;
    sum.slope -= 2.0 * ratio * ratio / (u + gap[i]);
  }
  return sum;
}

/// The largest root, or 0 if the function is negative from 0 on. Right of the last pole the function is convex and decreasing, so
/// Newton steps from the left never pass the root. Rounding ends the iteration.
double largest_root(const Vector3& z, const Vector3& gap) {
  double u = std::max((z - gap).maxCoeff(), 0.0);
  if (u == 0.0 && !(secular(z, gap, u).value > 0.0)) return 0.0;
  for (;;) {
    const Secular at = secular(z, gap, u);
    if (!(at.value > 0.0)) return u;
    const double next = u - at.value / at.slope;
    if (!(next > u)) return u;
    u = next;
  }
}

/// The point of the ellipsoid nearest to p, with p in the first octant and radii in decreasing order. The nearest point x
/// satisfies p - x = t (x_i / r_i^2), so x_i = r_i^2 p_i / (t + r_i^2) with the largest t for which x is on the surface (Eberly,
/// "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013). In units of the smallest radius, u = t / r_3^2
/// + 1.
Vector3 nearest_in_octant(const Vector3& radii, const Vector3& p) {
  const Vector3 scale = radii / radii[2];
  const Vector3 gap = scale.array().square() - 1.0;
  const Vector3 z = scale.cwiseProduct(p / radii[2]);
  const double u = largest_root(z, gap);
  Vector3 x = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (z[i] > 0.0) x[i] = scale[i] * scale[i] * p[i] / (u + gap[i]);
  }
  // On the medial disc two points are nearest, one above and one below it.
  if (u == 0.0) x[2] = radii[2] * std::sqrt(std::max(-secular(z, gap, 0.0).value, 0.0));
  return x;
}

}  // namespace

SurfacePoint surface_point(const EllipsoidGeometry& ellipsoid, const Vector3& p) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return ellipsoid.radii[i] > ellipsoid.radii[j]; });
  Vector3 radii;
  Vector3 folded;
  for (int i = 0; i < 3; ++i) {
    radii[i] = ellipsoid.radii[order[i]];
    folded[i] = std::abs(p[order[i]]);
  }
  const Vector3 nearest = nearest_in_octant(radii, folded);

  SurfacePoint found;
  for (int i = 0; i < 3; ++i) found.point[order[i]] = std::signbit(p[order[i]]) ? -nearest[i] : nearest[i];
  // The gradient of the sum of (x_i / r_i)^2. It has a direction even if p is on the surface.
  const Vector3 unit = found.point.cwiseQuotient(ellipsoid.radii);
  found.normal = unit.cwiseQuotient(ellipsoid.radii / radii[2]).normalized();
  found.distance = found.normal.dot(p - found.point);
  return found;
}

}  // namespace sprung
