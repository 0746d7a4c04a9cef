// Normals of the vertices of a mesh, for export.
#pragma once

#include "base/types.h"

namespace sprung {

/// The angle-weighted mean of the normals of the triangles around each vertex, of unit length, 3 x n. Triangles without area do not
/// contribute; a vertex without any other gets (0, 1, 0).
[[nodiscard]] Points vertex_normals(const Points& vertices, const Triangles& triangles);

}  // namespace sprung
