#include "geometry/mesh/topology.h"

#include "geometry/mesh/union_find.h"

#include <algorithm>
#include <tuple>

namespace sprung {
namespace {

struct HalfEdge {
  Index low;
  Index high;
  Index triangle;
  Index opposite;
  bool forward;
};

std::vector<HalfEdge> sorted_half_edges(const Triangles& triangles) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * static_cast<std::size_t>(triangles.cols()));
  for (Index t = 0; t < triangles.cols(); ++t) {
    for (Index corner = 0; corner < 3; ++corner) {
      const Index from = triangles(corner, t);
      const Index to = triangles((corner + 1) % 3, t);
      halves.push_back({std::min(from, to), std::max(from, to), t, triangles((corner + 2) % 3, t), from < to});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return halves;
}

}  // namespace

std::vector<MeshEdge> mesh_edges(const Triangles& triangles) {
  std::vector<MeshEdge> edges;
  edges.reserve(2 * static_cast<std::size_t>(triangles.cols()));
  for (const HalfEdge& half : sorted_half_edges(triangles)) {
    const std::array<Index, 2> vertices{half.low, half.high};
    if (edges.empty() || edges.back().vertices != vertices) edges.push_back({.vertices = vertices});
    MeshEdge& edge = edges.back();
    if (edge.uses < 2) {
      edge.triangles[edge.uses] = half.triangle;
      edge.opposite[edge.uses] = half.opposite;
      edge.forward[edge.uses] = half.forward;
    }
    ++edge.uses;
  }
  return edges;
}

bool is_closed(const Triangles& triangles) {
  const std::vector<MeshEdge> edges = mesh_edges(triangles);
  return !edges.empty() &&
         std::all_of(edges.begin(), edges.end(), [](const MeshEdge& e) { return e.uses == 2 && e.forward[0] != e.forward[1]; });
}

Edges unique_edges(const Triangles& triangles) {
  const std::vector<MeshEdge> edges = mesh_edges(triangles);
  Edges result(2, edges.size());
  for (Index e = 0; e < result.cols(); ++e) result.col(e) << edges[e].vertices[0], edges[e].vertices[1];
  return result;
}

VertexTriangles triangles_around_vertices(const Triangles& triangles, Index vertices) {
  VertexTriangles around{std::vector<Index>(vertices + 1, 0), std::vector<Index>(triangles.size())};
  for (const Index vertex : triangles.reshaped()) ++around.first[vertex + 1];
  std::partial_sum(around.first.begin(), around.first.end(), around.first.begin());
  std::vector<Index> next(around.first.begin(), around.first.end() - 1);
  for (Index t = 0; t < triangles.cols(); ++t) {
    for (Index corner = 0; corner < 3; ++corner) around.triangle[next[triangles(corner, t)]++] = t;
  }
  return around;
}

Index connected_components(const Triangles& triangles) {
  if (triangles.cols() == 0) return 0;
  const Index vertices = triangles.maxCoeff() + 1;
  UnionFind sets(vertices);
  for (Index t = 0; t < triangles.cols(); ++t) {
    for (Index corner = 1; corner < 3; ++corner) sets.join(triangles(corner, t), triangles(0, t));
  }
  std::vector<bool> counted(static_cast<std::size_t>(vertices), false);
  Index count = 0;
  for (Index t = 0; t < triangles.cols(); ++t) {
    const Index root = sets.root(triangles(0, t));
    if (!counted[root]) ++count;
    counted[root] = true;
  }
  return count;
}

}  // namespace sprung
