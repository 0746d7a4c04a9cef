// Consistent winding: neighbours agree, and what encloses a volume faces outward.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace sprung {

struct OrientationReport {
  Index flipped_faces = 0;
  Index one_sided_parts = 0;  ///< parts like a Moebius strip, that no winding makes consistent
  Index flat_parts = 0;       ///< closed ones that enclose no volume, like both sides of a sheet: they have no inside
};

/// Turns faces so that any two that share an edge with no third run along it in opposite directions. Of the two ways to do so, a
/// closed part takes the one that faces outward; one that lies inside another closed part keeps its turn relative to that one,
/// so that the wall of a cavity stays a wall; an open part takes the way that most of its faces had.
/// Requires three different vertices a triangle.
OrientationReport orient_faces(TriangleMesh& mesh);

}  // namespace sprung
