// Angle-weighted pseudonormals: the sign of the distance to a closed mesh (Baerentzen and Aanaes 2005).
#pragma once

#include "geometry/mesh/topology.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/queries/closest_point.h"

namespace sprung {

/// Pseudonormals of a mesh's faces, edges and vertices; none is normalised, only their direction counts.
struct Pseudonormals {
  Points face;    ///< 3 x m, unit length
  Points edge;    ///< 3 x 3m: column 3 t + k is the edge of triangle t from corner k to the next one
  Points vertex;  ///< 3 x n

  [[nodiscard]] Vector3 at(const Triangles& triangles, Index triangle, TriangleFeature feature) const;
};

/// Requires consistently oriented faces without degenerate ones, as `clean_mesh` leaves them.
[[nodiscard]] Pseudonormals pseudonormals(const TriangleMesh& mesh);

/// One of them, with the same bits: for a mesh that deforms, of which few are asked for before it is another. `around` is that of
/// the mesh. Triangles without area count nothing: where no other is, the result is zero.
[[nodiscard]] Vector3 pseudonormal(const TriangleMesh& mesh, const VertexTriangles& around, Index triangle,
                                   TriangleFeature feature);

}  // namespace sprung
