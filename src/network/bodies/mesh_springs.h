// Selects the vertex pairs of a polygon mesh that a body joins by springs. Internal to network/.
#pragma once

#include "network/bodies/body_shape.h"

#include <vector>

namespace sprung {

/// A future spring: two different vertices and the area of the mesh [m^2] that it represents.
struct Joint {
  Index first = 0;  ///< the lower vertex
  Index second = 0;
  SpringKind kind = SpringKind::structural;
  double area = 0.0;
};

/// The joints of make_mesh_body, sorted by their vertices, at most one per pair.
///
/// A face of area A with n corners gives 2 A / n to each of its edges and divides 2 A among its diagonals. An edge gives half the
/// area of its two faces to each of the two bend springs across it (between triangles, both are the same spring). So a grid of
/// rectangles gets the areas of a cloth (length times distance to the parallel neighbours), and the structural springs of any
/// evenly stretched mesh pull with the tension modulus * strain.
[[nodiscard]] std::vector<Joint> mesh_joints(const PolygonMesh& mesh);

}  // namespace sprung
