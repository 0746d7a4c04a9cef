// Angle-weighted pseudonormals: the sign of the distance to a closed mesh (Baerentzen and Aanaes 2005).
#pragma once

#include "geometry/mesh/topology.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/queries/closest_point.h"

namespace sprung {

/// Pseudonormals of the faces, edges and vertices of a mesh. Their length has no meaning unless stated.
struct Pseudonormals {
  Points face;    ///< 3 x m, unit length
  Points edge;    ///< 3 x 3m: column 3 t + k is the edge of triangle t from corner k to corner k + 1
  Points vertex;  ///< 3 x n

  [[nodiscard]] Vector3 at(const Triangles& triangles, Index triangle, TriangleFeature feature) const;
};

/// Requires consistently oriented faces, none degenerate, as `clean_mesh` returns them.
[[nodiscard]] Pseudonormals pseudonormals(const TriangleMesh& mesh);

/// One pseudonormal, with the same bits as in `pseudonormals(mesh)`. Use it for a deforming mesh of which few pseudonormals are
/// needed. `around` belongs to the mesh. Triangles without area do not contribute: if there is no other, the result is zero.
[[nodiscard]] Vector3 pseudonormal(const TriangleMesh& mesh, const VertexTriangles& around, Index triangle,
                                   TriangleFeature feature);

}  // namespace sprung
