// The obstacles of a scene and their contacts with particles.
#pragma once

#include "collision/core/contact.h"
#include "collision/shapes/obstacle.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class ObstacleSet;

/// Paths of particles in one step.
struct VertexPaths {
  const Points& before;      ///< positions at t [m]; outside all obstacles
  const Points& after;       ///< positions at t + dt [m]
  const Scalars& thickness;  ///< of each particle [m]; the obstacle's thickness is added
  double margin = 0.0;       ///< contacts are detected up to max(gap, clearance) + margin [m]
};

class Environment {
 public:
  /// Throws InputError, which names every problem of every obstacle: invalid shapes, poses that are not finite, keyframes that are
  /// not sorted or not finite, materials that violate ContactMaterial.
  explicit Environment(std::vector<Obstacle> obstacles = {});
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  [[nodiscard]] const std::vector<Obstacle>& obstacles() const;
  [[nodiscard]] const ObstacleSet& set() const;

  /// Sets the interval from t to t_end [s] for all following queries. Not thread-safe; the queries are.
  void set_interval(double t, double t_end);
  struct Interval {
    double begin = 0.0;
    double end = 0.0;
  };
  [[nodiscard]] Interval interval() const;

  /// Replaces the contact material of an obstacle. Requires a material that keeps the rules of ContactMaterial. Not thread-safe.
  void set_material(Index obstacle, const ContactMaterial& material);

  /// Poses at the interval's begin and end.
  [[nodiscard]] const RigidTransform& pose_before(Index obstacle) const;
  [[nodiscard]] const RigidTransform& pose_after(Index obstacle) const;

  /// Mean velocity [m/s] with which the obstacle moves a position near its surface from `time` to `time + dt` [s]. It includes the
  /// deformation of the surface point nearest to `position` at the end of the interval.
  [[nodiscard]] Vector3 surface_velocity(Index obstacle, const Vector3& position, double time, double dt) const;

  /// Detects contacts of particles whose path crosses an obstacle or ends within max(gap, clearance) + margin of it. At most one
  /// contact per particle and obstacle, sorted by particle, then obstacle. If the path crosses the surface (decided exactly, in
  /// the obstacle's frame), the contact is at the crossing and its normal is on the side where the path begins. Otherwise the
  /// contact is at the surface point nearest to `after` and its normal points outward. A particle that starts inside a closed mesh
  /// and ends near its surface, or ends anywhere inside a primitive, is therefore moved out. Positions that are not finite have no
  /// contacts. The result does not depend on the number of threads.
  [[nodiscard]] std::vector<Contact> contacts(const VertexPaths& paths) const;

  /// The smallest distance [m] of a particle from an obstacle at pose_after, if it is below `radius` [m]; negative inside.
  [[nodiscard]] std::optional<double> min_distance(const Points& positions, double radius) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
