#include "geometry/mesh/mesh_report.h"

#include "base/format.h"
#include "geometry/mesh/topology.h"

namespace sprung {
namespace {

constexpr int kDigits = 6;

// Extents [m] beyond which the unit of a mesh is probably not the metre.
constexpr double kLargestUsual = 100.0;
constexpr double kSmallestUsual = 0.001;

// A mesh in millimetres is a thousand times too large. A floor may well be a hundred times as large as what lies on it, but then it
// is rarely larger than a room.
constexpr double kLargestInRoom = 10.0;
constexpr double kLargestRatio = 100.0;

}  // namespace

void describe_surface(const TriangleMesh& mesh, MeshReport& report) {
  for (const MeshEdge& edge : mesh_edges(mesh.triangles)) {
    report.border_edges += edge.uses == 1 ? 1 : 0;
    report.non_manifold_edges += edge.uses > 2 ? 1 : 0;
  }
  report.components = connected_components(mesh.triangles);
  report.closed = is_closed(mesh.triangles);
  report.bounds = bounds(mesh.vertices);
  if (report.non_manifold_edges == 0) return;
  report.notes.push_back(std::to_string(report.non_manifold_edges) +
                         " edge(s) have more than two faces: the mesh has no inside and is treated as a sheet");
}

std::optional<std::string> unit_note(const Box3& bounds, double scale, const OtherSizes& others, SizeSource source) {
  if (bounds.isEmpty()) return std::nullopt;
  const double extent = scale * bounds.sizes().maxCoeff();
  const bool outgrows = others.largest > 0.0 && extent > kLargestInRoom && extent > kLargestRatio * others.largest;
  const bool is_tiny = extent > 0.0 && others.smallest > kLargestRatio * extent && others.smallest <= kLargestInRoom;
  if (extent >= kSmallestUsual && extent <= kLargestUsual && !outgrows && !is_tiny) return std::nullopt;
  std::string size = "its largest extent is " + format_number(extent, kDigits) + " m";
  if (scale != 1.0) size += " with \"scale\" " + format_number(scale, kDigits);
  if (outgrows) size += ", " + format_number(extent / others.largest, 3) + " times that of anything else in the scene";
  if (is_tiny) size += ", anything else in the scene is at least " + format_number(others.smallest / extent, 3) + " times as large";
  if (source == SizeSource::shape) return size + ". Sizes are in metres: change the shape, or its \"scale\".";
  if (scale != 1.0) return size + ": is that intended?";
  if (is_tiny || extent < kSmallestUsual) return size + ": if the file is not in metres, place it with a larger \"scale\"";
  return size + ": if the file is in millimetres, place it with \"scale\": 0.001";
}

}  // namespace sprung
