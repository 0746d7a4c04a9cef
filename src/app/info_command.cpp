#include "app/commands.h"
#include "app/console.h"
#include "app/mesh_text.h"
#include "base/error.h"
#include "base/format.h"
#include "geometry/mesh_file.h"
#include "geometry/polygon_mesh.h"

#include <fmt/format.h>

#include <optional>

namespace sprung {
namespace {

constexpr int kDigits = 4;

std::string point_text(const Vector3& point) {
  return fmt::format("({}, {}, {})", format_number(point.x(), kDigits), format_number(point.y(), kDigits),
                     format_number(point.z(), kDigits));
}

std::string obstacle_text(const ImportedMesh& imported) {
  const MeshReport& report = imported.report;
  std::string text = "as an obstacle (vertices welded, faces as triangles)\n";
  text += text_row("size", describe_size(report.bounds) + ", from " + point_text(report.bounds.min()) + " to " +
                               point_text(report.bounds.max()));
  text +=
      text_row("vertices", fmt::format("{} (welded from {} corners as read)", imported.mesh.vertices.cols(), report.vertices_read));
  text += text_row("triangles", fmt::format("{} ({} as read)", imported.mesh.triangles.cols(), report.faces_read));
  text += text_row("surface", describe_closedness(report));
  if (report.closed) text += text_row("volume", format_number(signed_volume(imported.mesh), kDigits) + " m^3");
  text += text_row("components", std::to_string(report.components));
  const std::vector<std::string> done = repairs(report);
  for (const std::string& repair : done) text += text_row("repair", repair);
  if (done.empty()) text += text_row("repair", "nothing");
  for (const std::string& note : report.notes) text += text_row("note", note);
  if (const auto note = unit_note(report.bounds)) text += text_row("note", *note);
  return text;
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

// An OBJ of lines is no obstacle, but it can be a body.
std::optional<std::string> body_text_of(const std::string& file) {
  if (lower_case_extension(file) != ".obj") return std::nullopt;
  try {
    return body_text(read_obj(file));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

ExitCode info(const InfoOptions& options) {
  const std::optional<std::string> body = body_text_of(options.mesh);
  std::string text;
  try {
    text = obstacle_text(import_mesh(options.mesh)) + (body ? "\n" : "");
  } catch (const InputError& error) {
    if (!body) throw;
    text = std::string("not an obstacle: ") + error.what() + "\n\n";
  }
  print_result(text + body.value_or(""));
  return ExitCode::done;
}

}  // namespace sprung
