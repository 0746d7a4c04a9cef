// A corner before a face, or two edges, of the network that contact keeps an eye on.
#pragma once

#include "base/types.h"

#include <algorithm>
#include <array>

namespace sprung {

struct ContactCandidate {
  std::array<Index, 4> particles{};  ///< the corner and then the face's, or those of the edges
  bool edges = false;                ///< two edges
  std::array<Index, 2> elements{};   ///< that have the sides; of a corner, the one that owns it
  std::array<int, 2> edge{};         ///< of two edges: their numbers in these elements
  double gap = 0.0;                  ///< that contact keeps between them [m]
  double reach = 0.0;                ///< contact looks at them when they are nearer than this [m]
  Vector3 normal = Vector3::Zero();  ///< unit length or 0: the direction of their separation when they were measured last
  int rest = 0;                      ///< steps in which they need not be looked at
};

/// How far beyond its gap [m] contact looks in a step in which the forces alone lead its particles up to `way` [m]: passes lead
/// them less far. What is farther off than a part of the gap, and of that way, would not be touched.
[[nodiscard]] inline double margin_of_step(double gap, double way) {
  constexpr double kMarginOfGap = 0.1;
  constexpr double kMarginOfMotion = 0.5;
  return kMarginOfGap * gap + kMarginOfMotion * way;
}

/// What lies between the sides along a direction, negative where they overlap; `height(k)` is how far up particle k is.
template <class Height>
[[nodiscard]] double gap_along(const ContactCandidate& candidate, const Height& height) {
  return candidate.edges ? std::min(height(0), height(1)) - std::max(height(2), height(3))
                         : height(0) - std::max({height(1), height(2), height(3)});
}

/// The closest points of the two sides.
struct ClosestFeatures {
  std::array<double, 4> weights{};       ///< separation = sum_i weights_i x_i; those of the second side are at most 0
  Vector3 separation = Vector3::Zero();  ///< from the second side's point to the first's [m]
};

/// `x` are the particles' positions [m].
[[nodiscard]] ClosestFeatures closest_points(const ContactCandidate& candidate, const std::array<Vector3, 4>& x);

}  // namespace sprung
