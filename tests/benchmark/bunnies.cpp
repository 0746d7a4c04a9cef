#include "benchmark/bunnies.h"

#include "collision/sample_meshes.h"
#include "geometry/mesh/topology.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sprung::benchmarks {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using HalfedgeMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = HalfedgeMesh::Vertex_index;

constexpr Index kMostInstalled = 69000;

HalfedgeMesh to_halfedges(const TriangleMesh& mesh) {
  HalfedgeMesh result;
  std::vector<Vertex> vertices;
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    vertices.push_back(result.add_vertex({mesh.vertices(0, i), mesh.vertices(1, i), mesh.vertices(2, i)}));
  }
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const auto corner = mesh.triangles.col(t);
    const auto face = result.add_face(vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]);
    if (face == HalfedgeMesh::null_face()) throw std::runtime_error("the bunny is not a manifold");
  }
  return result;
}

TriangleMesh to_triangles(const HalfedgeMesh& mesh) {
  TriangleMesh result{Points(3, mesh.number_of_vertices()), Triangles(3, mesh.number_of_faces())};
  std::map<Vertex, Index> numbers;
  for (const Vertex vertex : mesh.vertices()) {
    const auto number = static_cast<Index>(numbers.size());
    numbers[vertex] = number;
    const Kernel::Point_3& p = mesh.point(vertex);
    result.vertices.col(number) << p.x(), p.y(), p.z();
  }
  Index t = 0;
  for (const auto face : mesh.faces()) {
    int corner = 0;
    for (const Vertex vertex : mesh.vertices_around_face(mesh.halfedge(face))) result.triangles(corner++, t) = numbers.at(vertex);
    ++t;
  }
  return result;
}

TriangleMesh simplified(const TriangleMesh& mesh, Index triangles) {
  HalfedgeMesh halfedges = to_halfedges(mesh);
  const auto edges = static_cast<std::size_t>(triangles / 2 * 3);  // of a closed mesh
  namespace simplification = CGAL::Surface_mesh_simplification;
  simplification::edge_collapse(halfedges, simplification::Count_stop_predicate<HalfedgeMesh>(edges));
  halfedges.collect_garbage();
  return to_triangles(halfedges);
}

/// Each triangle divided into four at the midpoints of its edges.
TriangleMesh subdivided(const TriangleMesh& mesh) {
  const Edges edges = unique_edges(mesh.triangles);
  const auto vertex_count = static_cast<Index>(mesh.vertices.cols());
  TriangleMesh result{Points(3, vertex_count + edges.cols()), Triangles(3, 4 * mesh.triangles.cols())};
  result.vertices.leftCols(vertex_count) = mesh.vertices;
  std::map<std::pair<Index, Index>, Index> middles;
  for (Index e = 0; e < edges.cols(); ++e) {
    middles[{edges(0, e), edges(1, e)}] = vertex_count + e;
    result.vertices.col(vertex_count + e) = 0.5 * (mesh.vertices.col(edges(0, e)) + mesh.vertices.col(edges(1, e)));
  }
  const auto middle = [&](Index a, Index b) { return middles.at({std::min(a, b), std::max(a, b)}); };
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Index a = mesh.triangles(0, t);
    const Index b = mesh.triangles(1, t);
    const Index c = mesh.triangles(2, t);
    const Index ab = middle(a, b);
    const Index bc = middle(b, c);
    const Index ca = middle(c, a);
    result.triangles.col(4 * t) << a, ab, ca;
    result.triangles.col(4 * t + 1) << ab, b, bc;
    result.triangles.col(4 * t + 2) << ca, bc, c;
    result.triangles.col(4 * t + 3) << ab, bc, ca;
  }
  return result;
}

TriangleMesh installed_bunny() {
  TriangleMesh mesh = test::bunny();
  const Box3 box = sprung::bounds(mesh.vertices);
  mesh.vertices.colwise() -= box.center();
  mesh.vertices /= box.sizes().maxCoeff();
  return mesh;
}

}  // namespace

const TriangleMesh& bunny(Index triangles) {
  static std::map<Index, TriangleMesh> made;
  const auto found = made.find(triangles);
  if (found != made.end()) return found->second;
  TriangleMesh mesh = triangles > kMostInstalled ? subdivided(bunny(triangles / 4)) : simplified(installed_bunny(), triangles);
  return made[triangles] = std::move(mesh);
}

}  // namespace sprung::benchmarks
