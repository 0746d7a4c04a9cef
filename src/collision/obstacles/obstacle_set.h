// The obstacles of one interval: their shapes, where they are at its begin and end, and which are near a box.
#pragma once

#include "collision/obstacles/broad_phase.h"

#include <memory>
#include <vector>

namespace sprung {

/// A particle's path in an obstacle's own frame, straight from where it was to where it is about to be. A moving obstacle is met in
/// its own frame, where it rests: at the interval's ends this path is exact, so the side on which a particle ends one step is the
/// side on which it begins the next, whatever way the obstacle took between. Rounding is no gap either: the next step computes the
/// same begin from the same position and pose. What deforms in its own frame takes the begin with it, as far as it takes the
/// surface nearest to it.
struct LocalPath {
  Vector3 begin;
  Vector3 end;
  Vector3 shift = Vector3::Zero();  ///< how far deforming took the begin [m]
};

class ObstacleSet {
 public:
  /// Throws InputError, naming every obstacle's shape, place, motion and material that cannot be used.
  explicit ObstacleSet(std::vector<Obstacle> obstacles);

  void set_interval(double t, double t_end);

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
  /// A position at the interval's begin in the frame of obstacle k.
  [[nodiscard]] Vector3 local_before(Index k, const Vector3& position) const {
    return into_before_[static_cast<std::size_t>(k)] * position;
  }
  /// A position at the interval's end in the frame of obstacle k.
  [[nodiscard]] Vector3 local(Index k, const Vector3& position) const {
    return into_after_[static_cast<std::size_t>(k)] * position;
  }

  [[nodiscard]] const RigidTransform& into_before(Index k) const { return into_before_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const RigidTransform& into_after(Index k) const { return into_after_[static_cast<std::size_t>(k)]; }

  /// Replaces `found` by the obstacles that may be within the box at the interval's end, ascending.
  void find_near(const Box3& box, std::vector<Index>& found) const { broad_phase_->find_near(box, found); }

  /// The least height [m] above obstacle k that a path is to end with: far above what rounding does to the path's coordinates and
  /// the obstacle's (1e-16 of the largest), far below anything seen.
  [[nodiscard]] double clearance(Index k, const Vector3& from, const Vector3& to) const;
  /// No path within the box has a larger clearance from any obstacle.
  [[nodiscard]] double max_clearance(const Box3& box) const;

  /// Where obstacle k carries a position in this interval: to the last bit where it was, if the obstacle rests.
  [[nodiscard]] Vector3 moved_position(Index k, const Vector3& from) const;
  [[nodiscard]] bool rests(Index k) const {
    return before(k).matrix() == after(k).matrix() && shape(k).largest_displacement() == 0.0;
  }

  /// How far deforming takes the surface of obstacle k that is nearest to a position at the interval's end, beside the pose, from
  /// time t to t_end [m].
  [[nodiscard]] Vector3 drift(Index k, const Vector3& position, double t, double t_end) const;

  /// The farthest [m] that any obstacle carries one of the positions in this interval.
  [[nodiscard]] double max_displacement(const Points& positions) const;

  [[nodiscard]] bool moves() const { return moves_; }

  [[nodiscard]] double max_thickness() const { return max_thickness_; }

 private:
  void measure(std::size_t k);
  [[nodiscard]] bool changes(std::size_t k) const { return obstacles_[k].motion.moves() || shapes_[k]->deforms(); }

  std::vector<Obstacle> obstacles_;
  std::vector<std::unique_ptr<ObstacleShape>> shapes_;
  std::vector<RigidTransform> before_;
  std::vector<RigidTransform> after_;
  std::vector<RigidTransform> into_before_;
  std::vector<RigidTransform> into_after_;
  std::unique_ptr<BroadPhase> broad_phase_;
  std::vector<double> magnitude_;  ///< of an obstacle's coordinates in this interval [m]
  double max_thickness_ = 0.0;
  bool moves_ = false;
};

}  // namespace sprung
