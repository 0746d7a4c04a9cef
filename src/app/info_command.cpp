#include "app/commands.h"
#include "app/console.h"
#include "app/text/mesh_text.h"
#include "base/error.h"
#include "base/format.h"
#include "geometry/import/mesh_file.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/tetrahedra/tetrahedra_mesh.h"
#include "scene/building/mesh_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace sprung {
namespace {

constexpr int kDigits = 4;

std::string point_text(const Vector3& point) {
  return fmt::format("({}, {}, {})", format_number(point.x(), kDigits), format_number(point.y(), kDigits),
                     format_number(point.z(), kDigits));
}

std::string size_text(const Box3& box) {
  return describe_size(box) + ", from " + point_text(box.min()) + " to " + point_text(box.max());
}

std::string volume_text(double volume) { return format_number(volume, kDigits) + " m^3"; }

std::string surface_text(const Points& vertices, const Triangles& triangles, const MeshReport& report, const std::string& volume) {
  std::string text = text_row("size", size_text(report.bounds));
  text += text_row("vertices", fmt::format("{} ({} before welding)", vertices.cols(), report.vertices_read));
  text += text_row("triangles", fmt::format("{} ({} before repairs)", triangles.cols(), report.faces_read));
  text += text_row("surface", describe_closedness(report));
  if (report.closed) text += text_row("volume", volume);
  text += text_row("components", std::to_string(report.components));
  const std::vector<std::string> done = repairs(report);
  for (const std::string& repair : done) text += text_row("repair", repair);
  if (done.empty()) text += text_row("repair", "none");
  for (const std::string& note : report.notes) text += text_row("note", note);
  if (const auto note = unit_note(report.bounds)) text += text_row("note", *note);
  return text;
}

std::string obstacle_text(const ImportedMesh& imported) {
  const auto& [mesh, report] = imported;
  return "as an obstacle (vertices welded, faces as triangles)\n" +
         surface_text(mesh.vertices, mesh.triangles, report, volume_text(signed_volume(mesh)));
}

std::string sequence_text(const ImportedSequence& imported) {
  const auto& [sequence, report] = imported;
  std::vector<double> volumes;
  double farthest = 0.0;
  for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
    volumes.push_back(signed_volume(sequence.frames[k], sequence.triangles));
    if (k == 0) continue;
    farthest = std::max(farthest, (sequence.frames[k] - sequence.frames[k - 1]).colwise().norm().maxCoeff());
  }
  const auto [least, most] = std::minmax_element(volumes.begin(), volumes.end());
  return "as a deforming obstacle (the same faces in every frame)\n" + text_row("frames", std::to_string(sequence.frames.size())) +
         text_row("fastest", fmt::format("a vertex moves {} m from one frame to the next", format_number(farthest, kDigits))) +
         surface_text(sequence.frames.front(), sequence.triangles, report,
                      fmt::format("{} to {}", format_number(*least, kDigits), volume_text(*most)));
}

std::string face_sizes(const PolygonFaces& faces) {
  Index triangles = 0;
  Index quads = 0;
  for (Index face = 0; face < faces.face_count(); ++face) {
    const Index corners = faces.corner_begin[face + 1] - faces.corner_begin[face];
    triangles += corners == 3 ? 1 : 0;
    quads += corners == 4 ? 1 : 0;
  }
  return fmt::format("{} ({} triangles, {} quads, {} with more corners)", faces.face_count(), triangles, quads,
                     faces.face_count() - triangles - quads);
}

std::string body_text(const PolygonMesh& mesh) {
  std::string text = "as a body (vertices, faces and their order kept)\n";
  text += text_row("particles", std::to_string(mesh.vertices.cols()));
  text += text_row("size", describe_size(bounds(mesh.vertices)));
  text += text_row("faces", face_sizes(mesh.faces));
  if (mesh.lines.cols() > 0) text += text_row("lines", std::to_string(mesh.lines.cols()));
  if (!mesh.faces.texcoords.empty()) text += text_row("UVs", std::to_string(mesh.faces.texcoords.size()));
  if (!mesh.faces.groups.empty()) text += text_row("groups", fmt::format("{}", fmt::join(mesh.faces.groups, ", ")));
  return text;
}

// An OBJ file of lines cannot be an obstacle, but it can be a body.
std::optional<std::string> body_text_of(const std::filesystem::path& file) {
  if (lower_case_extension(file) != ".obj") return std::nullopt;
  try {
    return body_text(read_obj(file));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Shortest and longest edge of tetrahedra [m], and the number of edges.
struct EdgeLengths {
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0.0;
  std::size_t count = 0;
};

EdgeLengths edge_lengths(const TetrahedraMesh& mesh) {
  std::set<std::pair<Index, Index>> edges;
  for (const std::array<Index, 4>& corners : mesh.tetrahedra) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) edges.insert(std::minmax(corners[a], corners[b]));
    }
  }
  EdgeLengths lengths{.count = edges.size()};
  for (const auto& [a, b] : edges) {
    const double length = (mesh.vertices.col(a) - mesh.vertices.col(b)).norm();
    lengths.shortest = std::min(lengths.shortest, length);
    lengths.longest = std::max(lengths.longest, length);
  }
  return lengths;
}

std::string tetrahedra_text(const TetrahedraMesh& mesh) {
  double volume = 0.0;
  for (const std::array<Index, 4>& corners : mesh.tetrahedra) volume += tetrahedron_volume(mesh.vertices, corners);
  const EdgeLengths edges = edge_lengths(mesh);
  const Box3 box = bounds(mesh.vertices);
  std::string text = "as a body of type \"tetrahedra\" (vertices and their order kept)\n";
  text += text_row("particles", std::to_string(mesh.vertices.cols()));
  text += text_row("size", size_text(box));
  text += text_row("tetrahedra", std::to_string(mesh.tetrahedra.size()));
  text += text_row("volume", volume_text(volume));
  text += text_row("edges", fmt::format("{}, {} to {} m long", edges.count, format_number(edges.shortest, kDigits),
                                        format_number(edges.longest, kDigits)));
  text += text_row("surface", fmt::format("{} triangles", boundary_triangles(mesh.tetrahedra).cols()));
  if (const auto note = unit_note(box)) text += text_row("note", *note);
  return text;
}

std::string mesh_text(const std::filesystem::path& file) {
  if (is_tetrahedra_file(file)) return tetrahedra_text(read_tetrahedra(file));
  const std::optional<std::string> body = body_text_of(file);
  try {
    return obstacle_text(import_mesh(file)) + (body ? "\n" + *body : "");
  } catch (const InputError& error) {
    if (!body) throw;
    return std::string("not an obstacle: ") + error.what() + "\n\n" + *body;
  }
}

std::vector<std::filesystem::path> find_meshes(const InfoOptions& options) {
  const MeshFinder finder("", all_mesh_paths(options.mesh_paths));
  std::vector<std::filesystem::path> files;
  std::vector<Problem> problems;
  for (const std::string& mesh : options.meshes) files.push_back(finder.find(mesh, "", problems).value_or(mesh));
  if (!problems.empty()) throw InputError(std::move(problems));
  return files;
}

}  // namespace

ExitCode info(const InfoOptions& options) {
  const std::vector<std::filesystem::path> files = find_meshes(options);
  print_result(files.size() == 1 ? mesh_text(files.front()) : sequence_text(import_sequence(files)));
  return ExitCode::done;
}

}  // namespace sprung
