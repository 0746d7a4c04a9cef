#include "output/exporters/ply_exporter.h"

#include "output/exporters/binary_text.h"

namespace sprung {
namespace {

constexpr Index kMostCorners = 255;  // of a list whose length is a uchar

bool has_long_face(const PolygonFaces& faces) {
  for (Index f = 0; f < faces.face_count(); ++f) {
    if (faces.corner_begin[f + 1] - faces.corner_begin[f] > kMostCorners) return true;
  }
  return false;
}

void append_count(std::string& bytes, Index count, bool is_long) {
  if (is_long) {
    append_little(bytes, static_cast<std::uint32_t>(count));
  } else {
    append_little(bytes, static_cast<std::uint8_t>(count));
  }
}

void append_faces(std::string& bytes, const PolygonFaces& faces) {
  const bool is_long = has_long_face(faces);
  for (Index f = 0; f < faces.face_count(); ++f) {
    const Index begin = faces.corner_begin[f];
    const Index end = faces.corner_begin[f + 1];
    append_count(bytes, end - begin, is_long);
    for (Index c = begin; c < end; ++c) append_little(bytes, static_cast<std::int32_t>(faces.vertex[c]));
    if (faces.texcoord.empty()) continue;
    append_count(bytes, 2 * (end - begin), true);
    for (Index c = begin; c < end; ++c) {
      const Index uv = faces.texcoord[c];
      for (const std::size_t k : {0U, 1U}) append_little(bytes, uv == kNone ? 0.0F : static_cast<float>(faces.texcoords[uv][k]));
    }
  }
}

std::string head(std::size_t vertices, bool has_state, const PolygonFaces& faces, const Edges& lines) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment Sprung " SPRUNG_VERSION "; lengths in m\n";
  text += "element vertex " + std::to_string(vertices) + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (has_state) {
    text += "property float vx\nproperty float vy\nproperty float vz\nproperty float stretch\nproperty uchar contact\n";
  }
  if (faces.face_count() > 0) {
    text += "element face " + std::to_string(faces.face_count()) + "\nproperty list ";
    text += has_long_face(faces) ? "uint" : "uchar";
    text += " int vertex_indices\n";
    if (!faces.texcoord.empty()) text += "property list uint float texcoord\n";
  }
  if (lines.cols() > 0) {
    text += "element edge " + std::to_string(lines.cols()) + "\nproperty int vertex1\nproperty int vertex2\n";
  }
  return text + "end_header\n";
}

}  // namespace

std::vector<std::string> PlyExporter::losses(bool /*tears*/) const {
  if (!has_materials(run().model) && !has_groups(run().model)) return {};
  return {"PLY has no groups and no materials of faces"};
}

std::string PlyExporter::bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const {
  const Points vertices = vertices_of(run().model, shape, frame.state);
  const PolygonFaces faces = faces_in(shape, frame);
  const bool is_body = shape.body != kNone;
  std::string bytes = head(static_cast<std::size_t>(vertices.cols()), is_body, faces, shape.lines);
  if (is_body) {
    const VertexState state = vertex_state(run().model, run().model.bodies[shape.body], frame.state);
    for (Index i = 0; i < static_cast<Index>(vertices.cols()); ++i) {
      append_points<float>(bytes, vertices.col(i));
      append_points<float>(bytes, state.velocities.col(i));
      append_little(bytes, state.stretch[i]);
      append_little(bytes, state.contact[i]);
    }
  } else {
    append_points<float>(bytes, vertices);
  }
  append_faces(bytes, faces);
  for (const Index end : shape.lines.reshaped()) append_little(bytes, static_cast<std::int32_t>(end));
  return bytes;
}

}  // namespace sprung
