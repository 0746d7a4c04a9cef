// Meshes of tetrahedra as bodies.
#pragma once

#include "geometry/tetrahedra/tetrahedra_mesh.h"
#include "network/bodies/body_shape.h"

namespace sprung {

/// One particle per vertex, in the same order. Structural springs lie along the edges; their rest lengths are the distances in the
/// mesh. There are no springs of the other kinds. The cells are the tetrahedra. The surface is the boundary, and its triangles face
/// outwards.
///
/// With a modulus E [Pa], the springs make a solid of Young's modulus E and Poisson's ratio 1/4 (`tetrahedra_springs.h`).
/// Throws InputError that names every broken rule: no tetrahedra, vertices that are not finite, corners that do not exist,
/// tetrahedra without positive volume, and materials for shear and bend springs.
[[nodiscard]] BodyShape make_tetrahedra_body(const TetrahedraMesh& mesh, const SpringMaterials& materials);

}  // namespace sprung
