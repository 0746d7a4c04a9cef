// The contact of one particle with one obstacle.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacles/obstacle_set.h"

#include <optional>

namespace sprung {

/// A particle on its way through one step.
struct VertexPath {
  Index particle = kNone;
  Vector3 before;          ///< where it was at t [m]
  Vector3 after;           ///< where it is about to be at t + dt [m]
  double thickness = 0.0;  ///< its own [m]; the obstacle's is added
  double margin = 0.0;     ///< a contact is found this much [m] beyond max(gap, clearance)
};

/// See Environment::contacts.
[[nodiscard]] std::optional<Contact> find_contact(const ObstacleSet& set, Index obstacle, const VertexPath& path);

/// The same, begun with what was found for the particle last, in the obstacle's frame.
[[nodiscard]] std::optional<Contact> find_contact(const ObstacleSet& set, Index obstacle, const VertexPath& path,
                                                  SurfaceMemory& memory);

}  // namespace sprung
