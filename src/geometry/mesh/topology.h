// Edges of a triangle mesh and the triangles beside them.
#pragma once

#include "base/types.h"

#include <array>
#include <vector>

namespace sprung {

/// An edge and the (at most two) triangles that it joins.
struct MeshEdge {
  std::array<Index, 2> vertices{};               ///< lower index first
  std::array<Index, 2> triangles{kNone, kNone};  ///< kNone: the edge is on a border
  std::array<Index, 2> opposite{kNone, kNone};   ///< the third vertex of each triangle
  std::array<bool, 2> forward{};                 ///< whether each triangle runs from the lower vertex to the higher
  Index uses = 0;                                ///< how many triangles share it; more than two: not a manifold
};

/// Unique edges, sorted by their vertices; the triangles of an edge by their numbers. Requires three different vertices a triangle.
[[nodiscard]] std::vector<MeshEdge> mesh_edges(const Triangles& triangles);

/// Each edge is shared by exactly two triangles that run along it in opposite directions; false for no triangles.
[[nodiscard]] bool is_closed(const Triangles& triangles);

/// Unique edges of triangles, 2 x m, lower index first, sorted.
[[nodiscard]] Edges unique_edges(const Triangles& triangles);

/// Which triangles use each vertex: those of vertex i are triangle[first[i]] to triangle[first[i + 1] - 1], ascending.
struct VertexTriangles {
  std::vector<Index> first;
  std::vector<Index> triangle;
};
[[nodiscard]] VertexTriangles triangles_around_vertices(const Triangles& triangles, Index vertices);

/// Number of connected components of the triangles (joined by shared vertices).
[[nodiscard]] Index connected_components(const Triangles& triangles);

}  // namespace sprung
