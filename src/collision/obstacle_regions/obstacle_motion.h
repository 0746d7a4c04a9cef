// How moving and deforming obstacles move the particles near them.
#pragma once

#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include <optional>
#include <vector>

namespace sprung {

/// A particle's position after an obstacle moved it together with an element.
struct MovedVertex {
  Index particle = kNone;
  double distance = 0.0;               ///< of the element from the obstacle [m]
  Vector3 position = Vector3::Zero();  ///< [m]
};

/// The displacement of a particle that makes room for an obstacle that approaches a pin.
struct Push {
  Index particle = kNone;
  double distance = 0.0;                   ///< of the element from the obstacle [m]
  Vector3 displacement = Vector3::Zero();  ///< as far as the obstacle approaches [m]
  double max_distance = 0.0;               ///< the particle may move this far: the size of an element [m]
};

/// Reads from the safe regions which obstacles are near a particle and where these move it in the obstacles' interval. Changes
/// nothing. Positions are [m]; `from` is where particles are at the begin of the interval, as a matrix 3 x n.
class ObstacleMotion {
 public:
  /// Keeps references to both. Requires regions that were last updated or renewed for this frame.
  ObstacleMotion(const ObstacleSafeRegions& regions, const ObstacleFrame& obstacles);

  /// The particles that may touch a moving obstacle, ascending, with the displacement that it gives them.
  [[nodiscard]] std::vector<ParticleDisplacement> displacements(const Points& from) const;

  /// The position to which a moving obstacle near the particle moves it without crossing itself or another obstacle; nothing if
  /// there is none.
  [[nodiscard]] std::optional<Vector3> moved(Index particle, const Vector3& from) const;

  /// Appends the positions to which the moving obstacles near the particle move it.
  void append_moved(Index particle, const Vector3& from, std::vector<Vector3>& positions) const;

  /// The particle, blocked by the first moving obstacle whose regions do not contain `position`; a vertex that stays if there is
  /// none.
  [[nodiscard]] BlockedVertex blocked_vertex(Index particle, const Vector3& from, const Vector3& position) const;

  /// The corners of elements that moving obstacles cross, moved as whole elements (see
  /// ObstacleShape::moved_element). Ascending by particle; a corner of several elements moves with the one nearest to its obstacle.
  [[nodiscard]] std::vector<MovedVertex> moved_with_elements(const Points& from) const;

  /// The pushes that obstacles exert on the other corners of elements at pins, relative to the pins, in this interval. Ascending by
  /// particle; of several elements the nearest counts. Requires that the regions were made for these paths.
  [[nodiscard]] std::vector<Push> pushes_at_pins(const StepPaths& paths) const;

 private:
  /// The obstacles that elements around the particle may touch, ascending.
  [[nodiscard]] std::vector<Index> near_obstacles(Index particle) const;
  /// A moving obstacle that an element around the particle may touch; kNone if there is none.
  [[nodiscard]] Index touched_obstacle(Index particle) const;
  /// Whether a particle that obstacle k moves to `position` would cross another obstacle.
  [[nodiscard]] bool crosses_another(Index k, Index particle, const Vector3& from, const Vector3& position) const;
  void append_moved_elements(Index patch, const Points& from, std::vector<MovedVertex>& corners) const;
  void append_pushes(Index patch, const PatchSafeRegions& regions, const StepPaths& paths, std::vector<Push>& pushes) const;

  const ObstacleSafeRegions& regions_;
  const ObstacleFrame& obstacles_;
  const CollisionSurface& surface_;
};

}  // namespace sprung
