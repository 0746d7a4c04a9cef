// The two ends of a rod or spring.
#pragma once

#include "collision/shapes/obstacle.h"
#include "collision/shapes/surface_anchor.h"
#include "network/model/spring_network.h"

#include <array>
#include <span>
#include <vector>

namespace sprung {

/// The ends of a link as a weighted sum of particles, whose weights are 1 for the first end and negative for the second. Without
/// an obstacle they add up to 0, so that a pull at the ends conserves momentum. A pull along the line between the ends conserves
/// angular momentum too.
class LinkEnds {
 public:
  /// Keeps a reference to the obstacle, if there is one.
  LinkEnds(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, const Link& link);

  [[nodiscard]] std::span<const Index> particles() const { return {particles_.data(), count_}; }
  [[nodiscard]] double weight(std::size_t k) const { return weights_[k]; }

  /// The weighted sum of the columns of the particles, 3 x n.
  [[nodiscard]] Vector3 sum(const Points& columns) const;

  /// Where the obstacle has the second end at a time [m]; 0 without an obstacle, where `sum` includes the second end.
  [[nodiscard]] Vector3 anchor(double time) const;

  /// The velocity between the ends that a unit of impulse at them gives [1/kg]; 0 if neither end can move.
  [[nodiscard]] double inverse_mass(const Scalars& inverse_masses) const;

 private:
  std::array<Index, 4> particles_{};
  std::array<double, 4> weights_{};
  std::size_t count_ = 0;
  const Obstacle* obstacle_ = nullptr;
  SurfaceAnchor surface_;  ///< on a deforming obstacle
  Vector3 local_;          ///< on a rigid one
};

/// The mean rest length of the network's springs [m], a scale for what is short; 1 without springs.
[[nodiscard]] double mean_spring_length(const SpringNetwork& network);

}  // namespace sprung
