// The obstacles of a scene: shapes, motions, materials. ObstacleFrame says where they are in an interval.
#pragma once

#include "collision/shapes/obstacle.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

class BroadPhase;
class ObstacleShape;
struct PosedObstacles;

/// `obstacles.ball`, or `obstacles[2]` if it has no name.
[[nodiscard]] std::string obstacle_key(const Obstacle& obstacle, std::size_t number);

/// Const after construction, except for the materials. Const members may be called from several threads at the same time, and take
/// constant time. Construction is costly: it checks each mesh and builds a tree of its n triangles, O(n log n). Copies share shapes
/// and broad phase.
class ObstacleSet {
 public:
  /// Throws InputError, which names every problem of every obstacle: invalid shapes, poses that are no rotation and translation,
  /// keyframes that are not sorted or not finite, materials that violate ContactMaterial.
  explicit ObstacleSet(std::vector<Obstacle> obstacles = {});

  [[nodiscard]] const std::vector<Obstacle>& obstacles() const { return obstacles_; }
  [[nodiscard]] const Obstacle& obstacle(Index k) const { return obstacles_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] bool empty() const { return obstacles_.empty(); }

  /// The shape of obstacle k, of a deforming one at time 0.
  [[nodiscard]] const ObstacleShape& shape(Index k) const { return *shapes_[static_cast<std::size_t>(k)]; }

  /// Whether any obstacle ever moves or deforms.
  [[nodiscard]] bool moves() const { return moves_; }

  [[nodiscard]] double max_thickness() const { return max_thickness_; }  ///< [m]

  /// Replaces the motion of obstacle k. The pose at the present time must stay the same. Not thread-safe.
  void set_motion(Index k, const Motion& motion);

  /// Replaces the contact material of obstacle k. Requires a material that keeps the rules of ContactMaterial. Not thread-safe.
  void set_material(Index k, const ContactMaterial& material);

 private:
  friend class ObstacleFrame;

  void pose();
  [[nodiscard]] bool changes(std::size_t k) const;
  /// All obstacles in an interval [s].
  [[nodiscard]] std::shared_ptr<const PosedObstacles> posed(double begin, double end) const;

  std::vector<Obstacle> obstacles_;
  std::vector<std::shared_ptr<const ObstacleShape>> shapes_;
  std::shared_ptr<const BroadPhase> broad_phase_;
  std::shared_ptr<const PosedObstacles> at_start_;  ///< at time 0
  double max_thickness_ = 0.0;
  bool moves_ = false;
};

}  // namespace sprung
