// Edges of a triangle mesh and the triangles beside them.
#pragma once

#include "base/types.h"

#include <array>
#include <vector>

namespace sprung {

/// An edge and the (at most two) triangles that it joins.
struct MeshEdge {
  std::array<Index, 2> vertices{};               ///< ascending
  std::array<Index, 2> triangles{kNone, kNone};  ///< kNone: border edge
  std::array<Index, 2> opposite{kNone, kNone};   ///< the third vertex of each triangle
  std::array<bool, 2> forward{};                 ///< whether each triangle runs from the lower vertex to the higher one
  Index uses = 0;                                ///< number of triangles that share the edge; more than two: not a manifold
};

/// Unique edges, sorted by their vertices; the triangles of an edge are sorted by number. Requires three different vertices per
/// triangle.
[[nodiscard]] std::vector<MeshEdge> mesh_edges(const Triangles& triangles);

/// Whether each edge is shared by exactly two triangles that run along it in opposite directions. False for no triangles.
[[nodiscard]] bool is_closed(const Triangles& triangles);

/// Unique edges of triangles, 2 x m, lower index first, sorted.
[[nodiscard]] Edges unique_edges(const Triangles& triangles);

/// The triangles that use each vertex: those of vertex i are triangle[first[i]] to triangle[first[i + 1] - 1], ascending.
struct VertexTriangles {
  std::vector<Index> first;
  std::vector<Index> triangle;
};
[[nodiscard]] VertexTriangles triangles_around_vertices(const Triangles& triangles, Index vertices);

/// Number of connected components of the triangles. Triangles are connected if they share a vertex.
[[nodiscard]] Index connected_components(const Triangles& triangles);

}  // namespace sprung
