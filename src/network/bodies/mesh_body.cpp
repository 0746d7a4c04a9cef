#include "base/format.h"
#include "geometry/mesh/topology.h"
#include "network/bodies/body_rules.h"
#include "network/bodies/body_shape.h"
#include "network/bodies/mesh_springs.h"
#include "network/bodies/shape_parts.h"
#include "network/bodies/triangle_bends.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace sprung {
namespace {

const char* const kExport = "export the mesh again, or repair it";

bool has_corner_ranges(const PolygonFaces& faces) {
  return !faces.corner_begin.empty() && faces.corner_begin.front() == 0 &&
         std::is_sorted(faces.corner_begin.begin(), faces.corner_begin.end()) &&
         static_cast<std::size_t>(faces.corner_begin.back()) == faces.vertex.size();
}

using Corners = std::vector<Index>;

Corners corners_of_face(const PolygonMesh& mesh, std::size_t face) {
  const auto first = mesh.faces.vertex.begin();
  return {first + mesh.faces.corner_begin[face], first + mesh.faces.corner_begin[face + 1]};
}

Corners ends_of_line(const PolygonMesh& mesh, std::size_t line) {
  const auto ends = mesh.lines.col(static_cast<Eigen::Index>(line));
  return {ends[0], ends[1]};
}

void check_vertices(const PolygonMesh& mesh, ProblemList& problems) {
  const auto count = static_cast<std::size_t>(mesh.vertices.cols());
  if (count == 0) problems.add("vertices", "0", "must be at least 1", kExport);
  require_affordable("vertices", std::to_string(count), static_cast<double>(count), problems);
  const auto vertex = [&](std::size_t v) -> Vector3 { return mesh.vertices.col(static_cast<Eigen::Index>(v)); };
  problems.require_each(
      count, [&](std::size_t v) { return vertex(v).allFinite(); }, [&](std::size_t v) { return vector_text(vertex(v)); },
      EntryRule{"vertices", "must be finite", kExport});
}

// `corners_of(i)` are the vertices of entry i, for i < `count`.
template <class CornersOf>
void check_corners(const std::string& key, std::size_t count, const CornersOf& corners_of, std::size_t least, Index vertex_count,
                   ProblemList& problems) {
  const auto text = [&](std::size_t i) { return counts_text(corners_of(i)); };
  const auto exists = [&](Index v) { return v >= 0 && v < vertex_count; };
  const auto all_exist = [&](std::size_t i) {
    const Corners corners = corners_of(i);
    return std::all_of(corners.begin(), corners.end(), exists);
  };
  const auto all_differ = [&](std::size_t i) {
    Corners corners = corners_of(i);
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) == corners.end();
  };
  problems.require_each(
      count, [&](std::size_t i) { return corners_of(i).size() >= least; }, text,
      EntryRule{key, "must have at least " + std::to_string(least) + " corners", kExport});
  problems.require_each(count, all_exist, text,
                        EntryRule{key, "must name vertices of the mesh, which has " + std::to_string(vertex_count), kExport});
  problems.require_each(count, all_differ, text, EntryRule{key, "must not name a vertex twice", kExport});
}

bool has_angles(const SpringMaterials& materials) {
  return materials.bend && materials.bend_model == SpringMaterials::BendModel::angle;
}

void require_modulus(const std::optional<SpringMaterial>& bend, ProblemList& problems) {
  if (!bend || bend->measure == SpringMaterial::Measure::modulus) return;
  problems.add("springs.bend.stiffness", format_number(bend->value),
               "is not for the angles of a mesh, whose stiffness follows from its triangles", "give modulus, D in N m");
}

void check(const PolygonMesh& mesh, const SpringMaterials& materials, const std::vector<MeshPart>& parts) {
  ProblemList problems;
  check_vertices(mesh, problems);
  const auto vertex_count = static_cast<Index>(mesh.vertices.cols());
  if (has_corner_ranges(mesh.faces)) {
    const auto corners = [&](std::size_t face) { return corners_of_face(mesh, face); };
    check_corners("faces", static_cast<std::size_t>(mesh.faces.face_count()), corners, 3, vertex_count, problems);
  } else {
    problems.add("faces.corner_begin", "", "must rise from 0 to the number of corners", kExport);
  }
  const auto ends = [&](std::size_t line) { return ends_of_line(mesh, line); };
  check_corners("lines", static_cast<std::size_t>(mesh.lines.cols()), ends, 2, vertex_count, problems);
  if (has_angles(materials)) {
    require_modulus(materials.bend, problems);
    for (const MeshPart& part : parts) require_modulus(part.materials.bend, problems);
  }
  require_materials(materials, problems);
  problems.throw_if_any();
}

const std::optional<SpringMaterial>& of_kind(const SpringMaterials& materials, SpringKind kind) {
  if (kind == SpringKind::structural) return materials.structural;
  return kind == SpringKind::shear ? materials.shear : materials.bend;
}

/// The faces and lines of the part alone.
PolygonMesh cut_out(const PolygonMesh& mesh, const MeshPart& part) {
  PolygonMesh alone{.vertices = mesh.vertices, .faces = {}, .lines = Edges(2, static_cast<Index>(part.lines.size()))};
  for (const Index face : part.faces) {
    const Corners corners = corners_of_face(mesh, static_cast<std::size_t>(face));
    alone.faces.vertex.insert(alone.faces.vertex.end(), corners.begin(), corners.end());
    alone.faces.corner_begin.push_back(static_cast<Index>(alone.faces.vertex.size()));
  }
  for (Index line = 0; line < alone.lines.cols(); ++line) alone.lines.col(line) = mesh.lines.col(part.lines[line]);
  return alone;
}

/// The materials of the springs of parts, by ends and kind.
using MaterialsOfPairs = std::map<std::tuple<Index, Index, SpringKind>, const SpringMaterial*>;

MaterialsOfPairs materials_of_parts(const PolygonMesh& mesh, const std::vector<MeshPart>& parts) {
  MaterialsOfPairs materials;
  for (const MeshPart& part : parts) {
    for (const Joint& joint : mesh_joints(cut_out(mesh, part))) {
      const std::optional<SpringMaterial>& material = of_kind(part.materials, joint.kind);
      if (material) materials[{joint.first, joint.second, joint.kind}] = &*material;
    }
  }
  return materials;
}

// Without faces the mesh is a rope of lines, whose cross-section is 1.
void add_springs(const std::vector<Joint>& joints, SpringKind kind, const SpringMaterial& material,
                 const MaterialsOfPairs& of_parts, const std::string& key, bool has_faces, BodyShape& shape,
                 ProblemList& problems) {
  std::vector<Joint> unusable;
  for (const Joint& joint : joints) {
    if (joint.kind != kind) continue;
    const double length = (shape.positions[joint.second] - shape.positions[joint.first]).norm();
    const auto other = of_parts.find({joint.first, joint.second, kind});
    const SpringMaterial& own = other != of_parts.end() ? *other->second : material;
    if (own.measure == SpringMaterial::Measure::modulus && !(length > 0.0 && (joint.area > 0.0 || !has_faces))) {
      unusable.push_back(joint);
    } else {
      append_spring(shape.springs, joint.first, joint.second, length, own, has_faces ? joint.area / length : 1.0, kind);
    }
  }
  if (unusable.empty()) return;
  problems.add(key,
               std::to_string(unusable.size()) + " springs, the first from vertex " + std::to_string(unusable.front().first) +
                   " to " + std::to_string(unusable.front().second),
               "must have a length and an adjacent area, from which the stiffness follows with a modulus",
               "give `stiffness`, or remove such lines and faces from the mesh");
}

Edges lines_without_triangles(const Edges& lines, const Triangles& triangles) {
  std::set<std::array<Index, 2>> kept;
  for (const auto& line : lines.colwise()) kept.insert({std::min(line[0], line[1]), std::max(line[0], line[1])});
  const Edges edges = unique_edges(triangles);
  for (const auto& edge : edges.colwise()) kept.erase({edge[0], edge[1]});
  Edges result(2, static_cast<Eigen::Index>(kept.size()));
  Eigen::Index column = 0;
  for (const auto& [first, second] : kept) result.col(column++) << first, second;
  return result;
}

std::vector<double> lengths_of(const Edges& lines, const std::vector<Vector3>& positions) {
  std::vector<double> lengths;
  for (const auto& line : lines.colwise()) lengths.push_back((positions[line[1]] - positions[line[0]]).norm());
  return lengths;
}

void set_mesh_measures(BodyShape& shape) {
  const Surface& surface = shape.surface;
  if (surface.triangles.cols() > 0) {
    shape.dimension = 2;
    shape.measures = vertex_areas(shape.positions, surface.triangles);
  } else {
    shape.dimension = surface.segments.cols() > 0 ? 1 : 0;
    shape.measures.assign(shape.positions.size(), 0.0);
    add_segment_measures(surface.segments, lengths_of(surface.segments, shape.positions), shape.measures);
  }
  shape.measure = std::accumulate(shape.measures.begin(), shape.measures.end(), 0.0);
  shape.drag_areas = shape.dimension > 0 ? shape.measures : std::vector<double>(shape.positions.size(), 1.0);
  if (shape.dimension == 2) add_segment_measures(surface.segments, lengths_of(surface.segments, shape.positions), shape.drag_areas);
}

/// Of each triangle.
std::vector<const SpringMaterial*> bend_materials(const PolygonMesh& mesh, const SpringMaterials& materials,
                                                  const std::vector<MeshPart>& parts) {
  std::vector<const SpringMaterial*> of_faces(static_cast<std::size_t>(mesh.faces.face_count()), &*materials.bend);
  for (const MeshPart& part : parts) {
    if (!part.materials.bend) continue;
    for (const Index face : part.faces) of_faces[static_cast<std::size_t>(face)] = &*part.materials.bend;
  }
  std::vector<const SpringMaterial*> of_triangles;
  for (std::size_t face = 0; face < of_faces.size(); ++face) {
    const auto corners = static_cast<std::size_t>(mesh.faces.corner_begin[face + 1] - mesh.faces.corner_begin[face]);
    of_triangles.insert(of_triangles.end(), corners - 2, of_faces[face]);
  }
  return of_triangles;
}

void set_mesh_surface(BodyShape& shape, const PolygonMesh& mesh) {
  Surface& surface = shape.surface;
  surface.faces = mesh.faces;
  surface.triangles = triangulate(mesh.faces);
  surface.segments = lines_without_triangles(mesh.lines, surface.triangles);
}

}  // namespace

BodyShape make_mesh_body(const PolygonMesh& mesh, const SpringMaterials& materials, const std::vector<MeshPart>& parts) {
  check(mesh, materials, parts);
  BodyShape shape = shape_of_particles({mesh.vertices.colwise().begin(), mesh.vertices.colwise().end()}, materials);
  const std::vector<Joint> joints = mesh_joints(mesh);
  const MaterialsOfPairs of_parts = materials_of_parts(mesh, parts);
  ProblemList problems;
  const auto add = [&](const std::optional<SpringMaterial>& material, SpringKind kind, const std::string& key) {
    if (material) add_springs(joints, kind, *material, of_parts, key, mesh.faces.face_count() > 0, shape, problems);
  };
  add(materials.structural, SpringKind::structural, "springs.structural.modulus");
  add(materials.shear, SpringKind::shear, "springs.shear.modulus");
  if (!has_angles(materials)) add(materials.bend, SpringKind::bend, "springs.bend.modulus");
  problems.throw_if_any();
  set_mesh_surface(shape, mesh);
  if (has_angles(materials)) add_triangle_bends(bend_materials(mesh, materials, parts), shape);
  set_mesh_measures(shape);
  return shape;
}

}  // namespace sprung
