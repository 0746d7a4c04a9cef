#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace sprung {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kNumberOfNone = std::numeric_limits<std::uint64_t>::max();
constexpr int kDeepestNode = 200;  // assimp follows them recursively
constexpr std::uint64_t kMostPlacedVertices = 1'000'000'000;

// The numbers that the glTF specification gives them.
constexpr std::uint64_t kUnsignedByte = 5121;
constexpr std::uint64_t kUnsignedShort = 5123;
constexpr std::uint64_t kUnsignedInt = 5125;
constexpr std::uint64_t kFloat = 5126;
constexpr std::uint64_t kTriangles = 4;
constexpr std::uint64_t kTriangleFan = 6;

class InvalidGltf : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class Value>
Value value_at(std::string_view bytes, std::size_t at) {
  Value value{};
  std::memcpy(&value, bytes.data() + at, sizeof(Value));
  return value;
}

template <class Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

// The JSON text and the binary buffer. A text file has no buffer.
struct Chunks {
  std::string_view json;
  std::optional<std::string_view> buffer;
};

Chunks chunks_of(std::string_view bytes) {
  constexpr std::size_t kFileHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4e4f534a;
  constexpr std::uint32_t kBinary = 0x004e4942;
  if (!bytes.starts_with("glTF")) return {bytes, std::nullopt};
  if (bytes.size() < kFileHeader + kChunkHeader) throw InvalidGltf("is truncated");
  if (value_at<std::uint32_t>(bytes, 4) != 2) throw InvalidGltf("must be glTF of version 2.0");
  if (value_at<std::uint32_t>(bytes, 8) > bytes.size()) throw InvalidGltf("is truncated");
  Chunks chunks;
  bytes.remove_prefix(kFileHeader);
  for (bool first = true; bytes.size() >= kChunkHeader; first = false) {
    const auto size = value_at<std::uint32_t>(bytes, 0);
    const auto type = value_at<std::uint32_t>(bytes, 4);
    bytes.remove_prefix(kChunkHeader);
    if (size > bytes.size()) throw InvalidGltf("is truncated");
    if (first != (type == kJson)) throw InvalidGltf("must begin with one chunk of JSON");
    if (first) chunks.json = bytes.substr(0, size);
    if (type == kBinary && !chunks.buffer) chunks.buffer = bytes.substr(0, size);
    bytes.remove_prefix(size);
  }
  return chunks;
}

std::string decoded_base64(std::string_view text) {
  static const std::array<int, 256> kValues = [] {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < kDigits.size(); ++i) values[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
    return values;
  }();
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char digit : text) {
    const int value = kValues[static_cast<unsigned char>(digit)];
    if (value < 0) throw InvalidGltf("has a buffer that is not base64 text");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xffU);
  }
  return bytes;
}

// The member of an object, or null.
const Json& member(const Json& object, const char* key) {
  static const Json kNull;
  if (!object.is_object()) throw InvalidGltf(std::string("must have objects where \"") + key + "\" is expected");
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

const Json& entry(const Json& document, const char* list, std::uint64_t index) {
  const Json& all = member(document, list);
  if (!all.is_array() || index >= all.size()) {
    throw InvalidGltf("refers to number " + std::to_string(index) + " of \"" + list + "\", which does not exist");
  }
  return all[index];
}

std::uint64_t natural(const Json& object, const char* key, std::optional<std::uint64_t> otherwise = std::nullopt) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::int32_t>::max();
  const Json& value = member(object, key);
  if (value.is_null() && otherwise) return *otherwise;
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kLargest) {
    throw InvalidGltf(std::string("\"") + key + "\" must be a whole number of at most " + std::to_string(kLargest));
  }
  return value.get<std::uint64_t>();
}

// Numbers of a node; null if it has none.
Json numbers(const Json& node, const char* key, std::size_t count) {
  const Json& list = member(node, key);
  if (list.is_null()) return list;
  const auto is_float = [](const Json& number) {
    return number.is_number() && std::abs(number.get<double>()) <= static_cast<double>(std::numeric_limits<float>::max());
  };
  if (!list.is_array() || list.size() != count || !std::all_of(list.begin(), list.end(), is_float)) {
    throw InvalidGltf(std::string("\"") + key + "\" of a node must be " + std::to_string(count) + " finite numbers");
  }
  return list;
}

// Writes the default scene anew: its nodes, their triangles, and one buffer of floats and indices.
class GltfChecker {
 public:
  GltfChecker(const std::filesystem::path& file, const std::string& bytes) : folder_(file.parent_path()) {
    const Chunks chunks = chunks_of(bytes);
    binary_ = chunks.buffer;
    document_ = Json::parse(chunks.json, nullptr, false);
    if (document_.is_discarded()) throw InvalidGltf("is truncated or damaged: it is not valid JSON");
    const Json& version = member(member(document_, "asset"), "version");
    if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("2.")) {
      throw InvalidGltf("must be glTF of version 2.0");
    }
  }

  CheckedFile check() {
    const Json& roots = member(entry(document_, "scenes", natural(document_, "scene", 0)), "nodes");
    Json written_roots = Json::array();
    if (roots.is_array()) {
      for (const Json& root : roots) written_roots.push_back(node(root, 1));
    }
    if (placed_ == 0) throw InvalidGltf("has no faces");
    const Json written = {{"asset", {{"version", "2.0"}}},
                          {"scene", 0},
                          {"scenes", {{{"nodes", std::move(written_roots)}}}},
                          {"nodes", std::move(nodes_)},
                          {"meshes", std::move(meshes_)},
                          {"accessors", std::move(accessors_)},
                          {"bufferViews", std::move(views_)},
                          {"buffers", {{{"byteLength", buffer_.size()}}}}};
    return {"glb", container(written.dump())};
  }

 private:
  // Returns the number of the written node. Each node has one parent, so there is no cycle.
  std::size_t node(const Json& index, int depth) {
    if (!index.is_number_unsigned()) throw InvalidGltf("must refer to its nodes by numbers");
    if (depth > kDeepestNode) throw InvalidGltf("has nodes more than " + std::to_string(kDeepestNode) + " levels deep");
    const auto number = index.get<std::uint64_t>();
    const Json& read = entry(document_, "nodes", number);
    if (!seen_.insert(number).second) throw InvalidGltf("refers to node " + std::to_string(number) + " twice");

    Json written = Json::object();
    for (const auto& [key, count] : {std::pair{"matrix", 16}, {"translation", 3}, {"rotation", 4}, {"scale", 3}}) {
      if (Json list = numbers(read, key, static_cast<std::size_t>(count)); !list.is_null()) written[key] = std::move(list);
    }
    if (const std::uint64_t of_node = natural(read, "mesh", kNumberOfNone); of_node != kNumberOfNone) {
      if (const std::optional<std::size_t> its_mesh = mesh(of_node)) written["mesh"] = *its_mesh;
    }
    Json children = Json::array();
    if (const Json& list = member(read, "children"); list.is_array()) {
      for (const Json& child : list) children.push_back(node(child, depth + 1));
    }
    if (!children.empty()) written["children"] = std::move(children);
    nodes_.push_back(std::move(written));
    return nodes_.size() - 1;
  }

  struct Mesh {
    std::optional<std::size_t> written;  // none without triangles
    std::uint64_t vertices = 0;
  };

  std::optional<std::size_t> mesh(std::uint64_t index) {
    auto [known, is_new] = known_meshes_.try_emplace(index);
    if (is_new) {
      const Json& primitives = member(entry(document_, "meshes", index), "primitives");
      if (!primitives.is_array()) throw InvalidGltf("has a mesh without primitives");
      Json written = Json::array();
      for (const Json& primitive : primitives) {
        if (Json triangles = triangles_of(primitive, known->second.vertices); !triangles.is_null())
          written.push_back(std::move(triangles));
      }
      if (!written.empty()) {
        known->second.written = meshes_.size();
        meshes_.push_back({{"primitives", std::move(written)}});
      }
    }
    placed_ += known->second.vertices;
    if (placed_ > kMostPlacedVertices) throw InvalidGltf("has more than " + std::to_string(kMostPlacedVertices) + " vertices");
    return known->second.written;
  }

  // The primitive as written; null for points, lines, and primitives without positions.
  Json triangles_of(const Json& primitive, std::uint64_t& vertices) {
    if (member(member_or_empty(primitive, "extensions"), "KHR_draco_mesh_compression").is_object()) {
      throw InvalidGltf("is compressed by Draco, which is not read: export it without compression");
    }
    const std::uint64_t mode = natural(primitive, "mode", kTriangles);
    const std::uint64_t of_positions = natural(member_or_empty(primitive, "attributes"), "POSITION", kNumberOfNone);
    if (mode < kTriangles || mode > kTriangleFan || of_positions == kNumberOfNone) return nullptr;
    const auto [positions, count] = accessor(of_positions, true, 0);
    Json written = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
    std::uint64_t corners = count;
    if (const std::uint64_t of_indices = natural(primitive, "indices", kNumberOfNone); of_indices != kNumberOfNone) {
      const auto [indices, index_count] = accessor(of_indices, false, count);
      written["indices"] = indices;
      corners = index_count;
    }
    if (corners == 0) return nullptr;
    if (corners < 3 || (mode == kTriangles && corners % 3 != 0)) {
      throw InvalidGltf("has triangles with " + std::to_string(corners) + " corners in all");
    }
    vertices += count;
    return written;
  }

  static const Json& member_or_empty(const Json& object, const char* key) {
    static const Json kEmpty = Json::object();
    const Json& value = member(object, key);
    return value.is_null() ? kEmpty : value;
  }

  // Number and count of the written accessor: three floats per position, or one index below `limit`.
  std::pair<std::size_t, std::uint64_t> accessor(std::uint64_t index, bool positions, std::uint64_t limit) {
    const Json& read = entry(document_, "accessors", index);
    const std::uint64_t count = natural(read, "count");
    if (const auto known = known_accessors_.find({index, positions}); known != known_accessors_.end() && positions) {
      return {known->second, count};
    }
    const std::uint64_t component = natural(read, "componentType");
    const Json& type = member(read, "type");
    if (positions ? component != kFloat || type != "VEC3" : type != "SCALAR") {
      throw InvalidGltf(positions ? "has positions that are not three floats each" : "has indices that are not one number each");
    }
    std::string values = elements(read, count, positions ? 3 * sizeof(float) : size_of_index(component));
    if (!member(read, "sparse").is_null()) replace_sparse(member(read, "sparse"), count, positions, component, values);
    if (!positions) values = checked_indices(values, component, limit);
    known_accessors_.insert_or_assign({index, positions}, accessors_.size());
    views_.push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", values.size()}});
    buffer_ += values;
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", static_cast<std::uint64_t>(positions ? kFloat : kUnsignedInt)},
                          {"type", positions ? "VEC3" : "SCALAR"},
                          {"count", count}});
    return {accessors_.size() - 1, count};
  }

  static std::size_t size_of_index(std::uint64_t component) {
    if (component == kUnsignedByte) return 1;
    if (component == kUnsignedShort) return 2;
    if (component == kUnsignedInt) return 4;
    throw InvalidGltf("has indices of a type that is not allowed");
  }

  static std::uint32_t index_at(std::string_view values, std::size_t size, std::size_t i) {
    std::uint32_t value = 0;
    std::memcpy(&value, values.data() + i * size, size);
    return value;
  }

  static std::string checked_indices(std::string_view values, std::uint64_t component, std::uint64_t limit) {
    const std::size_t size = size_of_index(component);
    std::string written;
    for (std::size_t i = 0; i < values.size() / size; ++i) {
      const std::uint32_t index = index_at(values, size, i);
      if (index >= limit) {
        throw InvalidGltf("a corner must refer to one of the " + std::to_string(limit) + " vertices, but number " +
                          std::to_string(i + 1) + " does not");
      }
      append(written, index);
    }
    return written;
  }

  // The elements of an accessor, or of one component of a sparse accessor, without gaps.
  std::string elements(const Json& read, std::uint64_t count, std::size_t size) {
    const Json& of_view = member(read, "bufferView");
    if (of_view.is_null())
      throw InvalidGltf("has an accessor without a buffer, as compressed files have: export it without compression");
    const Json& view = entry(document_, "bufferViews", natural(read, "bufferView"));
    const std::string_view bytes = buffer(natural(view, "buffer"));
    const std::uint64_t view_begin = natural(view, "byteOffset", 0);
    const std::uint64_t view_size = natural(view, "byteLength");
    const std::uint64_t begin = natural(read, "byteOffset", 0);
    const std::uint64_t given_stride = natural(view, "byteStride", 0);
    const std::uint64_t stride = given_stride == 0 ? size : given_stride;
    const std::uint64_t end = count == 0 ? begin : begin + (count - 1) * stride + size;
    if (stride < size || view_begin + view_size > bytes.size() || end > view_size) {
      throw InvalidGltf("is truncated: an accessor reaches beyond its buffer");
    }
    std::string values;
    for (std::uint64_t i = 0; i < count; ++i) values += bytes.substr(view_begin + begin + i * stride, size);
    return values;
  }

  // Replaces elements by those of a sparse accessor.
  void replace_sparse(const Json& sparse, std::uint64_t count, bool positions, std::uint64_t component, std::string& values) {
    const std::uint64_t replaced = natural(sparse, "count");
    const Json& read_targets = member(sparse, "indices");
    const std::size_t target_size = size_of_index(natural(read_targets, "componentType"));
    const std::size_t size = positions ? 3 * sizeof(float) : size_of_index(component);
    const std::string targets = elements(read_targets, replaced, target_size);
    const std::string others = elements(member(sparse, "values"), replaced, size);
    for (std::uint64_t i = 0; i < replaced; ++i) {
      const std::uint32_t target = index_at(targets, target_size, i);
      if (target >= count) throw InvalidGltf("has a sparse accessor that replaces an element that does not exist");
      values.replace(target * size, size, others, i * size, size);
    }
  }

  std::string_view buffer(std::uint64_t index) {
    const auto known = buffers_.find(index);
    if (known != buffers_.end()) return known->second;
    const Json& uri = member(entry(document_, "buffers", index), "uri");
    if (uri.is_null() && index == 0 && binary_) return *binary_;
    if (!uri.is_string()) throw InvalidGltf("has a buffer without content");
    const std::string& text = uri.get_ref<const std::string&>();
    std::string bytes;
    if (text.starts_with("data:")) {
      const std::size_t comma = text.find(";base64,");
      if (comma == std::string::npos) throw InvalidGltf("has a buffer that is not base64 text");
      bytes = decoded_base64(std::string_view(text).substr(comma + std::string_view(";base64,").size()));
    } else {
      if (text.find('\0') != std::string::npos) throw InvalidGltf("has a buffer without content");
      bytes = read_mesh_file(folder_ / text);
    }
    return buffers_.emplace(index, std::move(bytes)).first->second;
  }

  [[nodiscard]] std::string container(std::string json) const {
    constexpr std::uint32_t kHeaders = 12 + 8 + 8;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string binary = buffer_;
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    if (binary.size() + json.size() > std::numeric_limits<std::uint32_t>::max() - kHeaders)
      throw InvalidGltf("is larger than 4 GB");
    std::string bytes = "glTF";
    append(bytes, std::uint32_t{2});
    append(bytes, static_cast<std::uint32_t>(kHeaders + json.size() + binary.size()));
    append(bytes, static_cast<std::uint32_t>(json.size()));
    (bytes += "JSON") += json;
    append(bytes, static_cast<std::uint32_t>(binary.size()));
    bytes.append("BIN\0", 4);
    return bytes += binary;
  }

  std::filesystem::path folder_;
  Json document_;
  std::optional<std::string_view> binary_;
  std::map<std::uint64_t, std::string> buffers_;
  std::set<std::uint64_t> seen_;
  std::map<std::uint64_t, Mesh> known_meshes_;
  std::map<std::pair<std::uint64_t, bool>, std::size_t> known_accessors_;
  Json nodes_ = Json::array();
  Json meshes_ = Json::array();
  Json accessors_ = Json::array();
  Json views_ = Json::array();
  std::string buffer_;
  std::uint64_t placed_ = 0;
};

}  // namespace

CheckedFile checked_gltf(const std::filesystem::path& file, const std::string& bytes) {
  FileProblems problems(file);
  try {
    return GltfChecker(file, bytes).check();
  } catch (const InvalidGltf& invalid) {
    problems.add("", "", invalid.what(), "export it again");
  }
  problems.throw_if_any();
  return {};
}

}  // namespace sprung
