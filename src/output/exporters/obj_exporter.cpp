#include "output/exporters/obj_exporter.h"

namespace sprung {

std::vector<std::string> ObjExporter::losses(bool /*tears*/) const {
  if (!has_materials(run().model)) return {};
  return {"the record has no material files, so the OBJ files have no materials; run the scene with --format obj"};
}

std::string ObjExporter::bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const {
  return obj_text(vertices_of(run().model, shape, frame.state), faces_in(shape, frame), shape.lines);
}

}  // namespace sprung
