// Obstacles in an FCL broad phase, and the contacts of particles with them.
#pragma once

#include "collision/core/contact.h"
#include "collision/shapes/obstacle.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class ObstacleSet;

/// Particles on their way through one step.
struct VertexPaths {
  const Points& before;      ///< where they were at t [m]; outside all obstacles
  const Points& after;       ///< where they are about to be at t + dt [m]
  const Scalars& thickness;  ///< of each particle [m]; the obstacle's own is added
  double margin = 0.0;       ///< contacts are found this much [m] beyond max(gap, clearance)
};

class Environment {
 public:
  /// Throws InputError, naming all problems of all obstacles: shapes that cannot be used, places that are not finite, motions whose
  /// keyframes are not sorted or not finite, materials that break the rules of ContactMaterial.
  explicit Environment(std::vector<Obstacle> obstacles = {});
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  [[nodiscard]] const std::vector<Obstacle>& obstacles() const;
  [[nodiscard]] const ObstacleSet& set() const;

  /// The next queries are for a step from time t to t + dt [s]. Not thread-safe; the queries below are.
  void set_interval(double t, double t_end);
  struct Interval {
    double begin = 0.0;
    double end = 0.0;
  };
  [[nodiscard]] Interval interval() const;

  /// Poses at the interval's begin and end.
  [[nodiscard]] const RigidTransform& pose_before(Index obstacle) const;
  [[nodiscard]] const RigidTransform& pose_after(Index obstacle) const;

  /// The velocity [m/s] with which the obstacle carries a position that is near its surface at the interval's end, over the `dt`
  /// [s] that follow `time`: by its motion, and by its deforming where the surface is nearest.
  [[nodiscard]] Vector3 surface_velocity(Index obstacle, const Vector3& position, double time, double dt) const;

  /// Contacts of particles whose path crosses an obstacle's surface or ends within max(gap, clearance) + margin of it, sorted by
  /// particle, then obstacle; at most one a pair. Where a path crosses the surface (exactly judged, in the obstacle's own frame)
  /// the contact is at the crossing, facing where the particle came from; else it is at the surface nearest to `after`, facing
  /// outward, so that a particle that began inside a closed obstacle and ends within reach of its surface (anywhere in a primitive)
  /// is led out. Positions that are not finite have no contacts. Same result for any number of threads.
  [[nodiscard]] std::vector<Contact> contacts(const VertexPaths& paths) const;

  /// Smallest distance [m] of any particle from any obstacle at pose_after, if within `radius`; negative inside.
  [[nodiscard]] std::optional<double> min_distance(const Points& positions, double radius) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
