// The obstacles in one interval: shapes, poses at its begin and end, broad phase.
#pragma once

#include "collision/obstacles/broad_phase.h"

#include <memory>
#include <vector>

namespace sprung {

/// The straight path of a particle in the frame of an obstacle, in which a rigid obstacle is at rest. Both ends are exact,
/// whatever the motion of the obstacle between them: the next step computes its begin from the same position and pose, so a
/// particle starts a step on the side on which it ended the previous one. If the obstacle deforms, the begin moves with the
/// nearest surface point.
struct LocalPath {
  Vector3 begin;
  Vector3 end;
  Vector3 shift = Vector3::Zero();  ///< displacement of the begin by deformation [m]
};

class ObstacleSet {
 public:
  /// Throws InputError, which names every problem of every obstacle: shape, pose, motion, material.
  explicit ObstacleSet(std::vector<Obstacle> obstacles);

  void set_interval(double t, double t_end);

  /// Requires a material that keeps the rules of ContactMaterial.
  void set_material(Index k, const ContactMaterial& material);

  [[nodiscard]] const std::vector<Obstacle>& obstacles() const { return obstacles_; }
  [[nodiscard]] const Obstacle& obstacle(Index k) const { return obstacles_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const ObstacleShape& shape(Index k) const { return *shapes_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const RigidTransform& before(Index k) const { return before_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const RigidTransform& after(Index k) const { return after_[static_cast<std::size_t>(k)]; }

  [[nodiscard]] LocalPath local_path(Index k, const Vector3& from, const Vector3& to) const {
    const Vector3 before = local_before(k, from);
    const Vector3 shift = shape(k).displacement(before);
    return {before + shift, local(k, to), shift};
  }
  /// Transforms a position at the begin of the interval into the frame of obstacle k.
  [[nodiscard]] Vector3 local_before(Index k, const Vector3& position) const {
    return into_before_[static_cast<std::size_t>(k)] * position;
  }
  /// Transforms a position at the end of the interval into the frame of obstacle k.
  [[nodiscard]] Vector3 local(Index k, const Vector3& position) const {
    return into_after_[static_cast<std::size_t>(k)] * position;
  }

  [[nodiscard]] const RigidTransform& into_before(Index k) const { return into_before_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const RigidTransform& into_after(Index k) const { return into_after_[static_cast<std::size_t>(k)]; }

  /// Replaces `found` by the obstacles that may intersect the box at the end of the interval, in ascending order.
  void find_near(const Box3& box, std::vector<Index>& found) const { broad_phase_->find_near(box, found); }

  /// The height [m] above obstacle k that the end of a path keeps at least. It is far above the rounding errors of the coordinates
  /// (1e-16 of the largest) and far below any visible distance.
  [[nodiscard]] double clearance(Index k, const Vector3& from, const Vector3& to) const;
  /// An upper bound of the clearance [m] of all paths within the box.
  [[nodiscard]] double max_clearance(const Box3& box) const;

  /// The position at the end of the interval of a point that moves with obstacle k. If the obstacle is at rest, the result equals
  /// `from` exactly.
  [[nodiscard]] Vector3 moved_position(Index k, const Vector3& from) const;
  [[nodiscard]] bool rests(Index k) const {
    return before(k).matrix() == after(k).matrix() && shape(k).largest_displacement() == 0.0;
  }

  /// Displacement [m] by deformation, without the pose, from t to t_end [s]: of the surface point of obstacle k that is nearest to
  /// a position at the end of the interval.
  [[nodiscard]] Vector3 drift(Index k, const Vector3& position, double t, double t_end) const;

  /// An upper bound of the displacement [m] in the interval of any of the positions if it moved with any obstacle.
  [[nodiscard]] double max_displacement(const Points& positions) const;

  [[nodiscard]] bool moves() const { return moves_; }

  [[nodiscard]] double max_thickness() const { return max_thickness_; }

 private:
  void update_magnitude(std::size_t k);
  [[nodiscard]] bool changes(std::size_t k) const { return obstacles_[k].motion.moves() || shapes_[k]->deforms(); }

  std::vector<Obstacle> obstacles_;
  std::vector<std::unique_ptr<ObstacleShape>> shapes_;
  std::vector<RigidTransform> before_;
  std::vector<RigidTransform> after_;
  std::vector<RigidTransform> into_before_;
  std::vector<RigidTransform> into_after_;
  std::unique_ptr<BroadPhase> broad_phase_;
  std::vector<double> magnitude_;  ///< largest coordinate of each obstacle in the interval [m]
  double max_thickness_ = 0.0;
  bool moves_ = false;
};

}  // namespace sprung
