#include "geometry/import/mesh_check.h"
#include "geometry/import/text_words.h"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace sprung {
namespace {

template <class Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

}  // namespace

void PlyWriter::add_vertex(const Vector3& position) { positions_.push_back(position); }

void PlyWriter::add_face(std::span<const std::int64_t> corners) {
  if (corners.size() < 3) return;
  append(faces_, static_cast<std::uint32_t>(corners.size()));
  for (const std::int64_t corner : corners) append(faces_, static_cast<std::uint32_t>(corner));
  ++face_count_;
}

CheckedFile PlyWriter::finish() {
  // assimp skips line ends after the header, even if they are the first bytes of a number: each vertex begins with a byte of 1.
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(positions_.size()) +
                      "\nproperty uchar guard\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(face_count_) + "\nproperty list uint uint vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + (1 + 3 * sizeof(float)) * positions_.size() + faces_.size());
  for (const Vector3& position : positions_) {
    append(bytes, std::uint8_t{1});
    for (const double coordinate : position) append(bytes, static_cast<float>(coordinate));
  }
  bytes += faces_;
  faces_.clear();
  face_count_ = 0;
  return {"ply", std::move(bytes), std::exchange(positions_, {})};
}

std::optional<double> finite_number(std::string_view word) {
  const std::optional<double> number = parse_number<double>(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<Vector3> finite_position(std::span<const std::string_view> words) {
  Vector3 position;
  if (words.size() < 3) return std::nullopt;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double> coordinate = finite_number(words[axis]);
    if (!coordinate) return std::nullopt;
    position[static_cast<Index>(axis)] = *coordinate;
  }
  return position;
}

}  // namespace sprung
