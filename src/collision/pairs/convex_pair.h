// Two convex parts of the network that a plane keeps apart.
#pragma once

#include "base/types.h"

#include <algorithm>
#include <array>

namespace sprung {

/// Each side is the convex hull of its particles: of an element, or, of elements that share a particle, a corner, an edge or a
/// face. The second side has three particles, or both have two. The sides share no particle.
struct ConvexPair {
  std::array<Index, 6> particles{};  ///< those of the first side first
  int first_count = 0;               ///< 1 to 3
  int second_count = 0;              ///< 2 or 3
  Vector3 normal = Vector3::Zero();  ///< unit length, from the second side towards the first

  [[nodiscard]] int count() const { return first_count + second_count; }
};

/// The unit vector from the second side towards the first in which they are farthest apart, by the nearest points or, where those
/// are too near each other for that, by the sides' faces and edges. Where the sides touch or cross, no gap is left along it.
[[nodiscard]] Vector3 direction_between(const ConvexPair& pair, const Points& positions);

/// How far down the first side reaches along the pair's normal, and how far up the second [m].
struct PairHeights {
  double first = 0.0;
  double second = 0.0;

  [[nodiscard]] double gap() const { return first - second; }  ///< negative where the sides overlap
};

/// `height(k)` is normal . x of particle k.
template <class Height>
[[nodiscard]] PairHeights heights_of(const ConvexPair& pair, const Height& height) {
  PairHeights heights{height(0), height(pair.first_count)};
  for (int k = 1; k < pair.first_count; ++k) heights.first = std::min(heights.first, height(k));
  for (int k = pair.first_count + 1; k < pair.count(); ++k) heights.second = std::max(heights.second, height(k));
  return heights;
}

[[nodiscard]] inline PairHeights heights_at(const ConvexPair& pair, const Points& positions) {
  return heights_of(pair, [&](int k) { return pair.normal.dot(positions.col(pair.particles[static_cast<std::size_t>(k)])); });
}

}  // namespace sprung
