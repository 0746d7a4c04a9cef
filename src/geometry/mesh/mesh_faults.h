// Faults that modelling programs leave in meshes and that a simulation does not show at once.
#pragma once

#include "geometry/mesh/polygon_mesh.h"

#include <vector>

namespace sprung {

/// The number of faces that lie on other faces, on the same side or back to back: (1) faces with the corners of an earlier face, in
/// any order; (2) faces with more than three corners that a fan of triangles covers.
/// `group_of`: the group of each vertex by coincident_groups().
[[nodiscard]] Index count_repeated_faces(const PolygonFaces& faces, const std::vector<Index>& group_of);

/// The vertices on a border that are within `distance` [m] of the inner part of another border edge: T-vertices. No vertex of that
/// edge is there to weld them to, so a seam stays open. Ascending. Requires distance >= 0.
[[nodiscard]] std::vector<Index> vertices_on_border_edges(const Points& vertices, const PolygonFaces& faces, double distance);

}  // namespace sprung
