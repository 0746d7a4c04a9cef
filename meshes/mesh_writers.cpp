#include "mesh_writers.h"

#include "base/format.h"

#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace sprung::meshes {
namespace {

static_assert(std::endian::native == std::endian::little, "all binary formats are written little-endian");

template <class Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

void append_floats(std::string& bytes, const Vector3& vector) {
  for (const double value : vector) append(bytes, static_cast<float>(value));
}

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string float_list(const Vector3& vector) {
  std::string text;
  for (const double value : vector) text += (text.empty() ? "[" : ", ") + format_number(static_cast<float>(value));
  return text + "]";
}

// The lines of the vertices, then those of the faces.
std::string element_lines(const TriangleMesh& mesh) {
  std::string text;
  for (const auto& vertex : mesh.vertices.colwise()) {
    for (Index k = 0; k < 3; ++k) text += format_number(vertex[k]) + (k < 2 ? ' ' : '\n');
  }
  for (const auto& triangle : mesh.triangles.colwise()) {
    text += '3';
    for (const Index vertex : triangle) text += ' ' + std::to_string(vertex);
    text += '\n';
  }
  return text;
}

std::string ply_header(const std::string& format, const TriangleMesh& mesh) {
  return "ply\nformat " + format + " 1.0\ncomment metres, Y up\nelement vertex " + std::to_string(mesh.vertices.cols()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(mesh.triangles.cols()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void append_glb_chunk(std::string& bytes, const char* type, std::string content, char filler) {
  content.resize((content.size() + 3) / 4 * 4, filler);
  append(bytes, static_cast<std::uint32_t>(content.size()));
  bytes.append(type, 4);
  bytes += content;
}

// A chunk's size counts its own header.
std::string three_ds_chunk(std::uint16_t id, const std::string& content) {
  std::string bytes;
  append(bytes, id);
  append(bytes, static_cast<std::uint32_t>(content.size() + 6));
  return bytes + content;
}

std::string node_place(const Place& place) {
  return R"("scale": )" + place.scale + R"(, "rotation": )" + place.rotation + R"(, "translation": )" + place.translation;
}

}  // namespace

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes = "binary STL, metres, Y up";
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.cols()));
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    append_floats(bytes, area_normal(mesh, t).normalized());
    for (Index k = 0; k < 3; ++k) append_floats(bytes, mesh.vertices.col(mesh.triangles(k, t)));
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string stl_text(const TriangleMesh& mesh) {
  std::string text = "solid shape\n";
  for (const auto& triangle : mesh.triangles.colwise()) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Index vertex : triangle) {
      text += "vertex";
      for (const double x : mesh.vertices.col(vertex)) append_number(text += ' ', x);
      text += '\n';
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string ply_bytes(const TriangleMesh& mesh) {
  std::string bytes = ply_header("binary_little_endian", mesh);
  for (const auto& vertex : mesh.vertices.colwise()) append_floats(bytes, vertex);
  for (const auto& triangle : mesh.triangles.colwise()) {
    append(bytes, std::uint8_t{3});
    for (const Index vertex : triangle) append(bytes, vertex);
  }
  return bytes;
}

std::string ply_text(const TriangleMesh& mesh) { return ply_header("ascii", mesh) + element_lines(mesh); }

std::string off_text(const TriangleMesh& mesh) {
  return "OFF\n# metres, Y up\n" + std::to_string(mesh.vertices.cols()) + ' ' + std::to_string(mesh.triangles.cols()) + " 0\n" +
         element_lines(mesh);
}

std::string gltf_text(const TriangleMesh& mesh, const Place& outer, const Place& inner) {
  std::string buffer;
  for (const auto& vertex : mesh.vertices.colwise()) append_floats(buffer, vertex);
  const std::string positions_end = std::to_string(buffer.size());
  for (const Index vertex : mesh.triangles.reshaped()) append(buffer, static_cast<std::uint16_t>(vertex));
  const std::string size = std::to_string(buffer.size());
  const std::string indices_size = std::to_string(mesh.triangles.size() * sizeof(std::uint16_t));
  const Box3 box = bounds(mesh.vertices);
  return R"({
  "asset": { "version": "2.0" },
  "scene": 0,
  "scenes": [ { "nodes": [0] } ],
  "nodes": [
    { "children": [1], )" +
         node_place(outer) + R"( },
    { "mesh": 0, )" +
         node_place(inner) + R"( }
  ],
  "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 }, "indices": 1 } ] } ],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
         std::to_string(mesh.vertices.cols()) + R"(,
      "min": )" +
         float_list(box.min()) + R"(, "max": )" + float_list(box.max()) + R"( },
    { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": )" +
         std::to_string(mesh.triangles.size()) + R"( }
  ],
  "bufferViews": [
    { "buffer": 0, "byteOffset": 0, "byteLength": )" +
         positions_end + R"( },
    { "buffer": 0, "byteOffset": )" +
         positions_end + R"(, "byteLength": )" + indices_size + R"( }
  ],
  "buffers": [ { "byteLength": )" +
         size + R"(, "uri": "data:application/octet-stream;base64,)" + base64(buffer) + R"(" } ]
}
)";
}

std::string glb_bytes(std::string json, std::string buffer) {
  std::string chunks;
  append_glb_chunk(chunks, "JSON", std::move(json), ' ');
  if (!buffer.empty()) append_glb_chunk(chunks, "BIN\0", std::move(buffer), '\0');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(chunks.size() + 12));
  return bytes + chunks;
}

std::string three_ds_bytes(const TriangleMesh& mesh) {
  std::string vertices;
  append(vertices, static_cast<std::uint16_t>(mesh.vertices.cols()));
  for (const auto& vertex : mesh.vertices.colwise()) append_floats(vertices, Vector3(vertex.x(), -vertex.z(), vertex.y()));
  std::string faces;
  append(faces, static_cast<std::uint16_t>(mesh.triangles.cols()));
  for (const auto& triangle : mesh.triangles.colwise()) {
    for (const Index vertex : triangle) append(faces, static_cast<std::uint16_t>(vertex));
    append(faces, std::uint16_t{0});
  }
  std::string name = "shape";
  name += '\0';
  std::string node = name;
  append(node, std::uint32_t{0});
  append(node, std::uint16_t{0xffff});  // no parent
  const std::string shape = three_ds_chunk(0x4100, three_ds_chunk(0x4110, vertices) + three_ds_chunk(0x4120, faces));
  const std::string objects = three_ds_chunk(0x3d3d, three_ds_chunk(0x4000, name + shape));
  return three_ds_chunk(0x4d4d, objects + three_ds_chunk(0xb000, three_ds_chunk(0xb002, three_ds_chunk(0xb010, node))));
}

}  // namespace sprung::meshes
