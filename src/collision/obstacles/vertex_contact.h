// Contact of one particle with one obstacle.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacles/obstacle_frame.h"

#include <optional>

namespace sprung {

/// Path of a particle in one step.
struct VertexPath {
  Index particle = kNone;
  Vector3 before;          ///< position at the begin of the interval [m]
  Vector3 after;           ///< position at its end [m]
  double thickness = 0.0;  ///< of the particle [m]; the obstacle's thickness is added
  double margin = 0.0;     ///< contacts are detected up to max(gap, clearance) + margin [m]
};

/// See ObstacleFrame::contacts.
[[nodiscard]] std::optional<Contact> find_contact(const ObstacleFrame& frame, Index obstacle, const VertexPath& path);

/// As above. Reuses `memory`, the result of the particle's last search, in the obstacle's frame.
[[nodiscard]] std::optional<Contact> find_contact(const ObstacleFrame& frame, Index obstacle, const VertexPath& path,
                                                  SurfaceMemory& memory);

}  // namespace sprung
