#include "output/exporters/obj_exporter.h"

#include "base/files/file_pattern.h"

#include <algorithm>

namespace sprung {
namespace {

std::string pattern_of(const ExportedShape& shape, int frames) {
  return shape.changes ? sequence_pattern(shape.stem(), frames) : shape.stem() + ".obj";
}

}  // namespace

ObjExporter::ObjExporter(ExportedRun run) : run_(std::move(run)), shapes_(shapes_of(run_.model)) {}

std::vector<std::string> ObjExporter::patterns() const {
  std::vector<std::string> patterns;
  for (const ExportedShape& shape : shapes_) patterns.push_back(pattern_of(shape, run_.frames));
  return patterns;
}

std::vector<std::string> ObjExporter::losses(bool /*tears*/) const {
  if (!has_materials(run_.model)) return {};
  return {"the record has no material files, so the OBJ files have no materials; run the scene with --format obj"};
}

std::vector<ExportedFile> ObjExporter::frame(const ExportedFrame& frame) {
  std::vector<ExportedFile> files;
  for (const ExportedShape& shape : shapes_) {
    if (!shape.changes && frame.number > 1) continue;
    files.push_back({fill_pattern(pattern_of(shape, run_.frames), frame.number),
                     obj_text(vertices_of(run_.model, shape, frame.state), faces_in(shape, frame), shape.lines)});
  }
  return files;
}

}  // namespace sprung
