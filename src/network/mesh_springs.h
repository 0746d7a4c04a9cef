// Which vertices of a polygon mesh a body joins by springs. Internal to network/.
#pragma once

#include "network/body_shape.h"

#include <vector>

namespace sprung {

/// A spring to be: two different vertices and the area of the mesh [m^2] that it stands for.
struct Joint {
  Index first = 0;  ///< the lower vertex
  Index second = 0;
  SpringKind kind = SpringKind::structural;
  double area = 0.0;
};

/// The joints of make_mesh_body, sorted by their vertices, no pair twice.
///
/// A face of area A and n corners gives 2 A / n to each of its edges and shares 2 A among its diagonals; an edge gives half the
/// area of its two faces to each of the two bend springs across it (both are one between triangles). A grid of rectangles so
/// gets the areas of a cloth (length times distance to the parallel neighbours), and any mesh that is stretched evenly has the
/// tension modulus * strain from its structural springs.
[[nodiscard]] std::vector<Joint> mesh_joints(const PolygonMesh& mesh);

}  // namespace sprung
