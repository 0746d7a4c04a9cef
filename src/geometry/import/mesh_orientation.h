// Consistent winding: neighbours agree, and a surface that encloses a volume faces outward.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace sprung {

struct OrientationReport {
  Index flipped_faces = 0;
  Index one_sided_components = 0;  ///< components that no winding makes consistent, like a Moebius strip
  Index flat_components = 0;       ///< closed components that enclose no volume, like both sides of a sheet: they have no inside
};

/// Reverses faces so that any two that share an edge with no third run along it in opposite directions. Each component has two
/// such windings. A closed component takes the one that faces outward. A closed component inside another one keeps its winding
/// relative to that one, so the wall of a cavity remains a wall. An open component takes the winding that most of its faces had.
/// Requires three different vertices per triangle.
OrientationReport orient_faces(TriangleMesh& mesh);

}  // namespace sprung
