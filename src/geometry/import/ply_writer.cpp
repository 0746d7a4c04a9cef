#include "geometry/import/mesh_check.h"
#include "geometry/import/text_words.h"

#include <array>
#include <cmath>
#include <cstring>

namespace sprung {
namespace {

template <class Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

}  // namespace

PlyWriter::PlyWriter(Kind kind, std::string_view x, std::string_view y, std::string_view z)
    : kind_(kind), types_{std::string(x), std::string(y), std::string(z)} {}

void PlyWriter::add_vertex(std::string_view x, std::string_view y, std::string_view z) {
  for (const std::string_view word : {x, y, z}) (vertices_ += word) += ' ';
  vertices_.back() = '\n';
  ++vertex_count_;
}

void PlyWriter::add_vertex(float x, float y, float z) {
  for (const float value : {x, y, z}) append(vertices_, value);
  ++vertex_count_;
}

void PlyWriter::add_face(std::span<const std::int64_t> corners) {
  if (corners.size() < 3) return;
  if (kind_ == Kind::binary) {
    append(faces_, static_cast<std::uint32_t>(corners.size()));
    for (const std::int64_t corner : corners) append(faces_, static_cast<std::uint32_t>(corner));
  } else {
    faces_ += std::to_string(corners.size());
    for (const std::int64_t corner : corners) (faces_ += ' ') += std::to_string(corner);
    faces_ += '\n';
  }
  ++face_count_;
}

CheckedFile PlyWriter::finish() const {
  std::string bytes = kind_ == Kind::ascii ? "ply\nformat ascii 1.0\n" : "ply\nformat binary_little_endian 1.0\n";
  bytes += "element vertex " + std::to_string(vertex_count_) + '\n';
  for (std::size_t k = 0; k < 3; ++k) bytes += "property " + types_[k] + ' ' + "xyz"[k] + '\n';
  bytes += "element face " + std::to_string(face_count_) + "\nproperty list uint uint vertex_indices\nend_header\n";
  return {"ply", bytes + vertices_ + faces_};
}

bool is_finite_number(std::string_view word) { return std::isfinite(parse_number<double>(word).value_or(std::nan(""))); }

}  // namespace sprung
