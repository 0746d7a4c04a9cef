// The obstacles in an interval of time: poses at its begin and end, shapes, boxes, and the queries that contact needs.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacles/broad_phase.h"
#include "collision/obstacles/obstacle_set.h"

#include <memory>
#include <optional>
#include <vector>

namespace sprung {

/// Paths of particles in one step.
struct VertexPaths {
  const Points& before;      ///< positions at the begin of the interval [m]; outside all obstacles
  const Points& after;       ///< positions at its end [m]
  const Scalars& thickness;  ///< of each particle [m]; the obstacle's thickness is added
  double margin = 0.0;       ///< contacts are detected up to max(gap, clearance) + margin [m]
};

/// The straight path of a particle in the frame of an obstacle, in which a rigid obstacle is at rest. Both ends are exact,
/// whatever the motion of the obstacle between them: the next step computes its begin from the same position and pose, so a
/// particle starts a step on the side on which it ended the previous one. If the obstacle deforms, the begin moves with the
/// nearest surface point.
struct LocalPath {
  Vector3 begin;
  Vector3 end;
  Vector3 shift = Vector3::Zero();  ///< displacement of the begin by deformation [m]
};

/// An obstacle in an interval.
struct PosedObstacle {
  RigidTransform before;       ///< pose at the begin
  RigidTransform after;        ///< pose at the end
  RigidTransform into_before;  ///< from world coordinates into the obstacle's frame at the begin
  RigidTransform into_after;   ///< likewise at the end
  std::shared_ptr<const ObstacleShape> shape;
  double magnitude = 0.0;   ///< largest coordinate in the interval [m]
  bool is_at_rest = false;  ///< neither pose nor shape differ between begin and end
};

struct PosedObstacles {
  std::vector<PosedObstacle> each;
  std::vector<ObstacleBound> changing;  ///< of the obstacles that ever move or deform
  double max_magnitude = 0.0;           ///< [m]
};

/// A value: its answers depend on the set and the interval alone. All functions are const and thread-safe. Frames of a set whose
/// obstacles never move share all data; other frames copy the poses and each deforming mesh. k is the number of an obstacle,
/// positions are [m] in world coordinates.
class ObstacleFrame {
 public:
  /// The interval from `begin` to `end` [s]. Keeps a reference to the set, and sees later changes of its materials.
  ObstacleFrame(const ObstacleSet& set, double begin, double end);
  ObstacleFrame(ObstacleSet&&, double, double) = delete;

  /// The frame of another interval [s], usually a part of this one. Equals a new frame.
  [[nodiscard]] ObstacleFrame part(double begin, double end) const { return {*set_, begin, end}; }

  [[nodiscard]] const ObstacleSet& set() const { return *set_; }
  [[nodiscard]] const Obstacle& obstacle(Index k) const { return set_->obstacle(k); }
  [[nodiscard]] double begin() const { return begin_; }  ///< [s]
  [[nodiscard]] double end() const { return end_; }      ///< [s]

  /// The shape in the interval.
  [[nodiscard]] const ObstacleShape& shape(Index k) const { return *posed(k).shape; }

  // Poses at the begin and the end, and their inverses.
  [[nodiscard]] const RigidTransform& before(Index k) const { return posed(k).before; }
  [[nodiscard]] const RigidTransform& after(Index k) const { return posed(k).after; }
  [[nodiscard]] const RigidTransform& into_before(Index k) const { return posed(k).into_before; }
  [[nodiscard]] const RigidTransform& into_after(Index k) const { return posed(k).into_after; }

  /// Transforms a position at the begin of the interval into the frame of obstacle k.
  [[nodiscard]] Vector3 local_before(Index k, const Vector3& position) const { return into_before(k) * position; }
  /// Transforms a position at the end of the interval into the frame of obstacle k.
  [[nodiscard]] Vector3 local(Index k, const Vector3& position) const { return into_after(k) * position; }
  [[nodiscard]] LocalPath local_path(Index k, const Vector3& from, const Vector3& to) const {
    const Vector3 begin = local_before(k, from);
    const Vector3 shift = shape(k).displacement(begin);
    return {begin + shift, local(k, to), shift};
  }

  /// Whether obstacle k neither moves nor deforms from begin to end.
  [[nodiscard]] bool is_at_rest(Index k) const { return posed(k).is_at_rest; }

  /// Replaces `found` by the obstacles that may intersect the box at the end of the interval, in ascending order.
  void find_near(const Box3& box, std::vector<Index>& found) const;

  /// The height [m] above obstacle k that the end of a path keeps at least. It is far above the rounding errors of the coordinates
  /// (1e-16 of the largest) and far below any visible distance.
  [[nodiscard]] double clearance(Index k, const Vector3& from, const Vector3& to) const;
  /// An upper bound of the clearance [m] of all paths within the box.
  [[nodiscard]] double max_clearance(const Box3& box) const;

  /// The position at the end of the interval of a point that moves with obstacle k. If the obstacle is at rest, the result equals
  /// `from` exactly.
  [[nodiscard]] Vector3 moved_position(Index k, const Vector3& from) const;

  /// An upper bound of the displacement [m] in the interval of any of the positions if it moved with any obstacle.
  [[nodiscard]] double max_displacement(const Points& positions) const;

  /// Mean velocity [m/s] with which obstacle k moves a position near its surface from `time` to `time + dt` [s]. It includes the
  /// deformation of the surface point nearest to `position` at the end of the interval.
  [[nodiscard]] Vector3 surface_velocity(Index k, const Vector3& position, double time, double dt) const;

  /// Detects contacts of particles whose path crosses an obstacle or ends within max(gap, clearance) + margin of it. At most one
  /// contact per particle and obstacle, sorted by particle, then obstacle. If the path crosses the surface (decided exactly, in
  /// the obstacle's frame), the contact is at the crossing and its normal is on the side where the path begins. Otherwise the
  /// contact is at the surface point nearest to `after` and its normal points outward. A particle that starts inside a closed mesh
  /// and ends near its surface, or ends anywhere inside a primitive, is therefore moved out. Positions that are not finite have no
  /// contacts. The result does not depend on the number of threads.
  [[nodiscard]] std::vector<Contact> contacts(const VertexPaths& paths) const;

  /// The smallest distance [m] of a particle from an obstacle at the end of the interval, if it is below `radius` [m]; negative
  /// inside.
  [[nodiscard]] std::optional<double> min_distance(const Points& positions, double radius) const;

 private:
  [[nodiscard]] const PosedObstacle& posed(Index k) const { return posed_->each[static_cast<std::size_t>(k)]; }

  const ObstacleSet* set_;
  double begin_;
  double end_;
  std::shared_ptr<const PosedObstacles> posed_;
};

/// Path of a particle in one step.
struct VertexPath {
  Index particle = kNone;
  Vector3 before;          ///< position at the begin of the interval [m]
  Vector3 after;           ///< position at its end [m]
  double thickness = 0.0;  ///< of the particle [m]; the obstacle's thickness is added
  double margin = 0.0;     ///< contacts are detected up to max(gap, clearance) + margin [m]
};

/// See ObstacleFrame::contacts. Reuses `memory`, the result of the particle's last search in the obstacle's frame, if it is given.
[[nodiscard]] std::optional<Contact> find_contact(const ObstacleFrame& frame, Index obstacle, const VertexPath& path,
                                                  SurfaceMemory* memory = nullptr);

}  // namespace sprung
