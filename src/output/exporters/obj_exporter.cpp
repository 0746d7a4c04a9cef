#include "output/exporters/obj_exporter.h"

#include "geometry/obj_source/vertex_lines.h"

#include <utility>

namespace sprung {
namespace {

std::string place_of(const RecordedBody& body, const MaterialFile& file) { return body.name + "/" + file.place; }

/// Whether it can be copied.
bool is_there(const MaterialFile& file) { return file.text || !file.source.empty(); }

PolygonFaces faces_of_particles(const RecordedBody& body) {
  PolygonFaces faces = body.faces;
  for (Index& vertex : faces.vertex) vertex = body.particle_of[vertex] - body.first_particle;
  return faces;
}

}  // namespace

ObjExporter::ObjExporter(ExportedRun exported) : SequenceExporter(std::move(exported), ".obj") {
  for (const ExportedShape& shape : shapes()) {
    Constant& constant = constants_.emplace_back();
    const RecordedBody* body = shape.body == kNone ? nullptr : &run().model.bodies[shape.body];
    if (body == nullptr || !body->source) {
      constant.elements = obj_text(Points(3, 0), shape.faces, shape.lines);
    } else if (body->source->file.writes_normals()) {
      constant.faces = faces_of_particles(*body);
      constant.triangles = triangulate(constant.faces);
    }
  }
}

std::vector<std::string> ObjExporter::patterns() const {
  std::vector<std::string> patterns = SequenceExporter::patterns();
  for (const RecordedBody& body : run().model.bodies) {
    if (!body.source) continue;
    for (const MaterialFile& file : body.source->materials.files) {
      if (is_there(file)) patterns.push_back(place_of(body, file));
    }
  }
  return patterns;
}

std::vector<std::string> ObjExporter::losses(bool /*tears*/) const {
  std::string missing;
  for (const RecordedBody& body : run().model.bodies) {
    if (!body.source) continue;
    for (const MaterialFile& file : body.source->materials.files) {
      if (!is_there(file)) missing.append(missing.empty() ? "" : ", ").append(place_of(body, file));
    }
  }
  if (missing.empty()) return {};
  return {"the record has no textures; copy these from beside the OBJ files of the scene: " + missing};
}

std::vector<ExportedFile> ObjExporter::frame(const ExportedFrame& frame) {
  std::vector<ExportedFile> files = SequenceExporter::frame(frame);
  if (frame.number > 1) return files;
  for (const RecordedBody& body : run().model.bodies) {
    if (!body.source) continue;
    for (const MaterialFile& file : body.source->materials.files) {
      if (is_there(file))
        files.push_back({.path = place_of(body, file), .bytes = file.text.value_or(""), .copy_of = file.text ? "" : file.source});
    }
  }
  return files;
}

std::string ObjExporter::bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const {
  const Constant& constant = constants_[static_cast<std::size_t>(&shape - shapes().data())];
  const bool may_tear = shape.body != kNone && static_cast<std::size_t>(shape.body) < frame.torn.size();
  const std::vector<Index> torn = may_tear ? frame.torn[shape.body] : std::vector<Index>();
  if (shape.body != kNone && run().model.bodies[shape.body].source) {
    const RecordedBody& body = run().model.bodies[shape.body];
    const bool has_torn_normals = body.source->file.writes_normals() && !torn.empty();
    return body.source->text(frame.state.positions.middleCols(body.first_particle, body.particle_count),
                             has_torn_normals ? triangulate(without_faces(constant.faces, torn)) : constant.triangles, torn);
  }
  const std::string vertices = vertex_lines(vertices_of(run().model, shape, frame.state));
  return vertices + (torn.empty() ? constant.elements : obj_text(Points(3, 0), without_faces(shape.faces, torn), shape.lines));
}

}  // namespace sprung
