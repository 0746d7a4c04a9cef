// Two triangles or two segments near each other, their ends in a step, and a brute-force check whether they cross in between.
#pragma once

#include "collision/pairs/contact_stencil.h"
#include "collision/sample_meshes.h"
#include "collision/self_networks.h"

#include <cmath>

namespace sprung::test {

/// Two triangles or two segments with a gap of up to a hundredth of their size.
struct NearbySides {
  ContactStencil pair;
  Points before;
};

inline NearbySides random_nearby_sides(int side, Random& random) {
  const Vector3 normal = random.direction();
  const Vector3 u = normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  const double gap = std::pow(10.0, random.between(-7.0, -2.0));
  NearbySides sides{.pair = {.first_count = side, .second_count = side}, .before = Points(3, 2 * side)};
  for (int k = 0; k < 2 * side; ++k) {
    const double away = k == 0 || k == side ? 0.0 : random.between(0.0, 0.2);
    const double height = k < side ? 0.5 * gap + away : -0.5 * gap - away;
    sides.before.col(k) = height * normal + random.between(-1.0, 1.0) * u + random.between(-1.0, 1.0) * v;
    sides.pair.particles[static_cast<std::size_t>(k)] = k;
  }
  sides.pair.normal = separating_direction(sides.pair, sides.before);
  return sides;
}

/// `before`, rotated by `angle` about a random axis, with a random displacement of up to `stray` [m] for each particle.
inline Points random_ends(const Points& before, double angle, double stray, Random& random) {
  const Matrix3 turn = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
  Points ends = turn * before;
  for (Index i = 0; i < static_cast<Index>(ends.cols()); ++i) ends.col(i) += random.between(0.0, stray) * random.direction();
  return ends;
}

/// Whether an edge of one triangle intersects the other at one of many times of the step.
inline bool cross_in_between(const Points& before, const Points& ends) {
  constexpr int kTimes = 64;
  for (int k = 0; k <= kTimes; ++k) {
    const double time = static_cast<double>(k) / kTimes;
    const Points x = (1.0 - time) * before + time * ends;
    for (const int first : {0, 3}) {
      const int second = 3 - first;
      for (int e = 0; e < 3; ++e) {
        if (segment_meets_triangle(x.col(first + e), x.col(first + (e + 1) % 3), x.col(second), x.col(second + 1),
                                   x.col(second + 2))) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace sprung::test
