#include "app/text/mesh_text.h"

#include "base/format.h"

#include <fmt/format.h>

namespace sprung {
namespace {

constexpr int kDigits = 4;

}  // namespace

std::string describe_size(const Box3& box) {
  if (box.isEmpty()) return "empty";
  const Vector3 size = box.sizes();
  return fmt::format("{} x {} x {} m", format_number(size.x(), kDigits), format_number(size.y(), kDigits),
                     format_number(size.z(), kDigits));
}

std::string describe_closedness(const MeshReport& report) {
  if (report.closed) return "closed";
  return fmt::format("open: {}, {} with more than two faces", counted(report.border_edges, "border edge"),
                     counted(report.non_manifold_edges, "edge"));
}

std::vector<std::string> repairs(const MeshReport& report) {
  std::vector<std::string> done;
  const auto add = [&](Index count, const char* what) {
    if (count > 0) done.push_back(fmt::format("{} {}", count, what));
  };
  add(report.unused_vertices, "unused vertices removed");
  add(report.degenerate_faces, "faces without area removed");
  add(report.duplicate_faces, "duplicate faces removed");
  add(report.flipped_faces, "faces flipped");
  return done;
}

std::string text_row(const std::string& label, const std::string& text) { return fmt::format("{:<12}{}\n", label, text); }

}  // namespace sprung
