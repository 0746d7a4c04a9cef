// Queries about all of a mesh rather than the nearest triangle: winding number, and triangles in a box.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"

#include <vector>

namespace sprung {

/// How often a closed mesh of outward triangles winds around p: 0 outside, 1 inside, more where components overlap. Exact if p is
/// not on the mesh: exact signs decide which triangles the ray from p along x crosses, and a ray through an edge or a vertex
/// passes it on the same side for all its triangles.
[[nodiscard]] int winding_number(const MeshBvh& tree, const Vector3& p);

/// Replaces `found` by the triangles whose boxes intersect the box. May include some whose boxes are only close to it.
void find_in_box(const MeshBvh& tree, const Box3& box, std::vector<Index>& found);

}  // namespace sprung
