// Divides the long edges of a triangle mesh.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace sprung {

/// The mesh with each edge longer than `longest` [m] divided into the fewest equal parts that are not, and rows of vertices no
/// farther apart within its triangles. The vertices of the mesh come first, as they are; the surface and its orientation stay.
/// Both triangles at an edge have the same vertices on it, and so have edges between the same places, as along seams. A mesh
/// without long edges stays as it is. Requires `longest` > 0.
[[nodiscard]] TriangleMesh divide_long_edges(TriangleMesh mesh, double longest);

}  // namespace sprung
