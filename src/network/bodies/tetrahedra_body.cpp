#include "network/bodies/tetrahedra_body.h"

#include "network/bodies/body_rules.h"
#include "network/bodies/shape_parts.h"
#include "network/bodies/tetrahedra_springs.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

void check(const TetrahedraMesh& mesh, const SpringMaterials& materials) {
  const char* const repair = "repair the mesh, or mesh it again";
  ProblemList problems;
  if (mesh.tetrahedra.empty()) problems.add("tetrahedra", "0", "must be at least 1", repair);
  require_affordable("vertices", std::to_string(mesh.vertices.cols()), static_cast<double>(mesh.vertices.cols()), problems);
  const auto vertex = [&](std::size_t v) -> Vector3 { return mesh.vertices.col(static_cast<Eigen::Index>(v)); };
  problems.require_each(
      static_cast<std::size_t>(mesh.vertices.cols()), [&](std::size_t v) { return vertex(v).allFinite(); },
      [&](std::size_t v) { return vector_text(vertex(v)); }, EntryRule{"vertices", "must be finite", repair});
  const auto exist = [&](std::size_t t) {
    return std::ranges::all_of(mesh.tetrahedra[t], [&](Index corner) { return corner >= 0 && corner < mesh.vertices.cols(); });
  };
  const auto text = [&](std::size_t t) { return counts_text(mesh.tetrahedra[t]); };
  problems.require_each(
      mesh.tetrahedra.size(), exist, text,
      EntryRule{"tetrahedra", "must name vertices of the mesh, which has " + std::to_string(mesh.vertices.cols()), repair});
  problems.require_each(
      mesh.tetrahedra.size(),
      [&](std::size_t t) { return !exist(t) || tetrahedron_volume(mesh.vertices, mesh.tetrahedra[t]) > 0.0; }, text,
      EntryRule{"tetrahedra", "must have a positive volume", repair});
  for (const auto& [key, material] : {std::pair("springs.shear", materials.shear), std::pair("springs.bend", materials.bend)}) {
    if (material)
      problems.add(key, "", "is not for tetrahedra, which have structural springs along their edges and no others", "remove it");
  }
  require_materials(materials, problems);
  problems.throw_if_any();
}

// k = modulus * cross-section / length, so that the cross-section is 6 V_e / L.
void add_springs(const TetrahedraMesh& mesh, const SpringMaterial& material, BodyShape& shape) {
  for (const TetrahedraEdge& edge : tetrahedra_edges(mesh.vertices, mesh.tetrahedra)) {
    const double length = (mesh.vertices.col(edge.second) - mesh.vertices.col(edge.first)).norm();
    append_spring(shape.springs, edge.first, edge.second, length, material, 6.0 * edge.volume / length, SpringKind::structural);
  }
}

std::vector<double> quarter_volumes(const TetrahedraMesh& mesh) {
  std::vector<double> volumes(static_cast<std::size_t>(mesh.vertices.cols()), 0.0);
  for (const std::array<Index, 4>& corners : mesh.tetrahedra) {
    const double quarter = tetrahedron_volume(mesh.vertices, corners) / 4.0;
    for (const Index corner : corners) volumes[corner] += quarter;
  }
  return volumes;
}

}  // namespace

BodyShape make_tetrahedra_body(const TetrahedraMesh& mesh, const SpringMaterials& materials) {
  check(mesh, materials);
  BodyShape shape = shape_of_particles({mesh.vertices.colwise().begin(), mesh.vertices.colwise().end()}, materials);
  if (materials.structural) add_springs(mesh, *materials.structural, shape);
  set_surface(shape, boundary_triangles(mesh.tetrahedra));
  shape.cells.tetrahedra = mesh.tetrahedra;
  shape.dimension = 3;
  shape.measures = quarter_volumes(mesh);
  shape.measure = std::accumulate(shape.measures.begin(), shape.measures.end(), 0.0);
  return shape;
}

}  // namespace sprung
