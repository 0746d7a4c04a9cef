// Joins vertices at the same place.
#pragma once

#include "geometry/mesh/polygon_mesh.h"

#include <vector>

namespace sprung {

/// The group of each vertex, represented by its lowest vertex. Vertices at most `distance` [m] apart belong to one group, and so do
/// chains of them. Requires distance >= 0.
[[nodiscard]] std::vector<Index> coincident_groups(const Points& vertices, double distance);

struct WeldedMesh {
  PolygonMesh mesh;              ///< a vertex for each group, at the place of its lowest vertex; faces and lines in their order
  std::vector<Index> vertex_of;  ///< the vertex of `mesh` that each vertex became
};

/// Makes one vertex of each group of `coincident_groups`. Throws InputError unless `distance` [m] is smaller than every edge of a
/// face and every line, and no face would have a corner twice.
[[nodiscard]] WeldedMesh weld(PolygonMesh mesh, double distance);

}  // namespace sprung
