#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

namespace sprung {
namespace {

// The chunks that define and transform surfaces; all others are left out.
constexpr std::uint16_t kMain = 0x4d4d;
constexpr std::uint16_t kEditor = 0x3d3d;
constexpr std::uint16_t kMasterScale = 0x0100;
constexpr std::uint16_t kMaterial = 0xafff;
constexpr std::uint16_t kMaterialName = 0xa000;
constexpr std::uint16_t kObject = 0x4000;
constexpr std::uint16_t kMesh = 0x4100;
constexpr std::uint16_t kVertices = 0x4110;
constexpr std::uint16_t kFaces = 0x4120;
constexpr std::uint16_t kFacesOfMaterial = 0x4130;
constexpr std::uint16_t kMatrix = 0x4160;
constexpr std::uint16_t kKeyframer = 0xb000;
constexpr std::uint16_t kObjectNode = 0xb002;
constexpr std::uint16_t kFirstNode = 0xb001;
constexpr std::uint16_t kLastNode = 0xb007;
constexpr std::uint16_t kNodeName = 0xb010;
constexpr std::uint16_t kDummyName = 0xb011;
constexpr std::uint16_t kPivot = 0xb013;
constexpr std::uint16_t kPositionTrack = 0xb020;
constexpr std::uint16_t kRotationTrack = 0xb021;
constexpr std::uint16_t kScaleTrack = 0xb022;

constexpr std::size_t kChunkHeader = 6;
constexpr std::size_t kVector = 12;
constexpr int kMostNodes = 2000;  // assimp follows them recursively
constexpr std::size_t kLongestName = 255;

class InvalidFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class Value>
void append(std::string& bytes, Value value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

std::string chunk(std::uint16_t id, const std::string& content) {
  std::string bytes;
  append(bytes, id);
  append(bytes, static_cast<std::uint32_t>(content.size() + kChunkHeader));
  return bytes + content;
}

// The unread bytes of one chunk.
class Reader {
 public:
  explicit Reader(std::string_view rest) : rest_(rest) {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }

  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw InvalidFile("is truncated: a chunk ends before its content does");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  template <class Value>
  Value number() {
    Value value{};
    std::memcpy(&value, take(sizeof(Value)).data(), sizeof(Value));
    return value;
  }

  /// A name with the 0 at its end.
  std::string name() {
    const std::size_t end = rest_.find('\0');
    if (end > kLongestName) throw InvalidFile("has a name without an end");
    return std::string(take(end + 1));
  }

  /// Calls `each(id, content)` for the remaining chunks. Fewer bytes than a header at the end are padding.
  template <class Each>
  void chunks(const Each& each) {
    while (rest_.size() >= kChunkHeader) {
      const auto id = number<std::uint16_t>();
      const auto size = number<std::uint32_t>();
      if (size < kChunkHeader) throw InvalidFile("has a chunk that is smaller than its header");
      each(id, Reader(take(size - kChunkHeader)));
    }
  }

 private:
  std::string_view rest_;
};

class Checker {
 public:
  CheckedFile check(const std::string& bytes) {
    Reader file(bytes);
    std::string content;
    bool found = false;
    file.chunks([&](std::uint16_t id, Reader reader) {
      if (id != kMain) return;
      found = true;
      content += main(reader);
    });
    if (!found) throw InvalidFile("does not begin like a 3DS file");
    if (faces_ == 0) throw InvalidFile("has no faces");
    return {"3ds", chunk(kMain, content)};
  }

 private:
  std::string main(Reader reader) {
    std::string kept;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id == kEditor) kept += chunk(id, editor(content));
      if (id == kKeyframer) kept += chunk(id, keyframer(content));
    });
    return kept;
  }

  std::string editor(Reader reader) {
    std::string kept;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id == kMasterScale) kept += chunk(id, std::string(content.take(sizeof(float))));
      if (id == kMaterial) kept += chunk(id, material(content));
      if (id == kObject) kept += object(content);
    });
    return kept;
  }

  // Faces are grouped by the names of their materials.
  static std::string material(Reader reader) {
    std::string kept;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id == kMaterialName) kept += chunk(id, content.name());
    });
    return kept;
  }

  // Cameras and lights are objects too.
  std::string object(Reader reader) {
    const std::string name = reader.name();
    std::string meshes;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id == kMesh) meshes += chunk(id, mesh(content));
    });
    return meshes.empty() ? "" : chunk(kObject, name + meshes);
  }

  std::string mesh(Reader reader) {
    std::string kept;
    std::size_t vertices = 0;
    std::optional<Reader> faces;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if ((id == kVertices && vertices > 0) || (id == kFaces && faces)) throw InvalidFile("has a mesh with two lists of one kind");
      if (id == kVertices) {
        vertices = content.number<std::uint16_t>();
        std::string list;
        append(list, static_cast<std::uint16_t>(vertices));
        kept += chunk(id, list += content.take(vertices * kVector));
      }
      if (id == kMatrix) kept += chunk(id, std::string(content.take(4 * kVector)));
      if (id == kFaces) faces = content;
    });
    return faces ? kept + chunk(kFaces, face_list(*faces, vertices)) : kept;
  }

  std::string face_list(Reader reader, std::size_t vertices) {
    const std::size_t count = reader.number<std::uint16_t>();
    std::string kept;
    append(kept, static_cast<std::uint16_t>(count));
    for (std::size_t face = 0; face < count; ++face) {
      for (int corner = 0; corner < 3; ++corner) {
        const auto vertex = reader.number<std::uint16_t>();
        if (vertex >= vertices) {
          throw InvalidFile("face " + std::to_string(face + 1) + " must refer to one of the " + std::to_string(vertices) +
                            " vertices");
        }
        append(kept, vertex);
      }
      append(kept, reader.number<std::uint16_t>());
    }
    faces_ += count;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id == kFacesOfMaterial) kept += chunk(id, faces_of_material(content, count));
    });
    return kept;
  }

  static std::string faces_of_material(Reader reader, std::size_t faces) {
    std::string kept = reader.name();
    const auto count = reader.number<std::uint16_t>();
    append(kept, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto face = reader.number<std::uint16_t>();
      if (face >= faces) throw InvalidFile("has a material for a face that does not exist");
      append(kept, face);
    }
    return kept;
  }

  std::string keyframer(Reader reader) {
    std::string kept;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id >= kFirstNode && id <= kLastNode) kept += chunk(id, node(id, content));
    });
    return kept;
  }

  // Nodes of lights and cameras stay, because the hierarchy refers to them.
  std::string node(std::uint16_t kind, Reader reader) {
    std::string kept;
    bool named = false;
    reader.chunks([&](std::uint16_t id, Reader content) {
      if (id == kNodeName) {
        if (named) throw InvalidFile("has a node with two names");
        named = true;
        kept += chunk(id, hierarchy_entry(content));
      }
      if (!named || kind != kObjectNode) return;
      if (id == kDummyName) kept += chunk(id, content.name());
      if (id == kPivot) kept += chunk(id, std::string(content.take(kVector)));
      if (id == kPositionTrack || id == kScaleTrack) kept += first_key(id, content, kVector);
      if (id == kRotationTrack) kept += first_key(id, content, sizeof(float) + kVector);
    });
    return kept;
  }

  std::string hierarchy_entry(Reader reader) {
    if (++nodes_ > kMostNodes) throw InvalidFile("has more than " + std::to_string(kMostNodes) + " nodes");
    std::string kept = reader.name();
    kept += reader.take(sizeof(std::uint32_t));
    const auto parent = reader.number<std::int16_t>();
    if (parent < -1 || parent >= kMostNodes) throw InvalidFile("has a node whose parent does not exist");
    append(kept, parent);
    return kept;
  }

  // The key of the earliest time, without its spline: it gives the transform of the node.
  static std::string first_key(std::uint16_t id, Reader reader, std::size_t value_size) {
    constexpr std::size_t kTrackHeader = 10;
    constexpr int kSplineValues = 5;
    std::string kept(reader.take(kTrackHeader));
    const auto count = reader.number<std::uint32_t>();
    std::optional<std::pair<std::uint32_t, std::string_view>> first;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto time = reader.number<std::uint32_t>();
      const auto spline = reader.number<std::uint16_t>();
      for (int bit = 0; bit < kSplineValues; ++bit) reader.take((spline >> bit & 1) * sizeof(float));
      const std::string_view value = reader.take(value_size);
      if (!first || time < first->first) first = {time, value};
    }
    if (!first) return "";
    append(kept, std::uint32_t{1});
    append(kept, first->first);
    append(kept, std::uint16_t{0});
    return chunk(id, kept += first->second);
  }

  std::size_t faces_ = 0;
  int nodes_ = 0;
};

}  // namespace

CheckedFile checked_3ds(const std::filesystem::path& file, const std::string& bytes) {
  FileProblems problems(file);
  try {
    return Checker().check(bytes);
  } catch (const InvalidFile& invalid) {
    problems.add("", "", invalid.what(), "export it again");
  }
  problems.throw_if_any();
  return {};
}

}  // namespace sprung
