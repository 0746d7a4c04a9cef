// What a point or a box has to do with all of a mesh, not only with the triangle next to it.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"

#include <vector>

namespace sprung {

/// How often a closed mesh of outward triangles winds around p: 0 outside, 1 inside, and more where components overlap. Exact, for
/// p that is not on the mesh: the triangles ahead of p along x are counted by exact signs, and a ray that meets an edge or a vertex
/// passes it on the same side of all its triangles.
[[nodiscard]] int winding_number(const MeshBvh& tree, const Vector3& p);

/// Replaces `found` by the triangles whose boxes meet the box, and perhaps by some that are close to it.
void find_in_box(const MeshBvh& tree, const Box3& box, std::vector<Index>& found);

}  // namespace sprung
