#include "output/exporters/gltf_exporter.h"

#include "base/error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>
#include <utility>

namespace sprung {
namespace {

constexpr int kMostTargets = 256;  // with the last frame
constexpr double kMostBytes = 100.0e6;
constexpr std::size_t kAlignment = 4;

// The colours of bodies and obstacles, linear.
constexpr std::array<double, 4> kBodyColour{0.55, 0.16, 0.10, 1.0};
constexpr std::array<double, 4> kObstacleColour{0.35, 0.36, 0.38, 1.0};

/// The vertices of a primitive: those of the shape, then copies for further UVs.
struct SplitVertices {
  std::vector<Index> vertex_of;                 ///< of each one its vertex of the shape
  std::vector<std::array<float, 2>> texcoords;  ///< empty without UVs
  std::vector<Index> corner;                    ///< of each corner its split vertex
};

SplitVertices split(const PolygonFaces& faces, Index count) {
  SplitVertices result;
  for (Index i = 0; i < count; ++i) result.vertex_of.push_back(i);
  if (faces.texcoord.empty()) {
    result.corner = faces.vertex;
    return result;
  }
  result.texcoords.resize(static_cast<std::size_t>(count), {0.0F, 0.0F});
  std::vector<Index> first_uv(static_cast<std::size_t>(count), kNone);
  std::map<std::pair<Index, Index>, Index> copies;
  const auto coordinates = [&](Index uv) {  // v counts from above
    return std::array<float, 2>{static_cast<float>(faces.texcoords[uv][0]), 1.0F - static_cast<float>(faces.texcoords[uv][1])};
  };
  for (std::size_t c = 0; c < faces.vertex.size(); ++c) {
    const Index vertex = faces.vertex[c];
    const Index uv = faces.texcoord[c];
    if (uv == kNone || first_uv[vertex] == uv) {
      result.corner.push_back(vertex);
    } else if (first_uv[vertex] == kNone) {
      first_uv[vertex] = uv;
      result.texcoords[vertex] = coordinates(uv);
      result.corner.push_back(vertex);
    } else {
      const auto [copy, is_new] = copies.try_emplace({vertex, uv}, static_cast<Index>(result.vertex_of.size()));
      if (is_new) {
        result.vertex_of.push_back(vertex);
        result.texcoords.push_back(coordinates(uv));
      }
      result.corner.push_back(copy->second);
    }
  }
  return result;
}

/// The triangles of the faces [begin, end), as split vertices.
std::vector<std::uint32_t> triangles(const PolygonFaces& faces, const SplitVertices& vertices, Index begin, Index end) {
  std::vector<std::uint32_t> corners;
  for (Index f = begin; f < end; ++f) {
    const Index first = faces.corner_begin[f];
    for (Index c = first + 1; c + 1 < faces.corner_begin[f + 1]; ++c) {
      for (const Index corner : {first, c, c + 1}) corners.push_back(static_cast<std::uint32_t>(vertices.corner[corner]));
    }
  }
  return corners;
}

}  // namespace

/// Fills the glTF model.
class GltfExporter::Builder {
 public:
  Builder() {
    model_.asset.version = "2.0";
    model_.asset.generator = "Sprung " SPRUNG_VERSION;
    model_.scenes.resize(1);
    model_.defaultScene = 0;
    model_.buffers.resize(1);
    model_.animations.resize(1);
    model_.animations[0].name = "simulation";
  }

  /// A material of this name and colour, which is made once.
  int add_material(const std::string& name, const std::array<double, 4>& colour) {
    const std::vector<double> base(colour.begin(), colour.end());
    const auto same = [&](const tinygltf::Material& other) {
      return other.name == name && other.pbrMetallicRoughness.baseColorFactor == base;
    };
    const auto found = std::ranges::find_if(model_.materials, same);
    if (found != model_.materials.end()) return static_cast<int>(found - model_.materials.begin());
    tinygltf::Material material;
    material.name = name;
    material.doubleSided = true;
    material.pbrMetallicRoughness.baseColorFactor = base;
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    material.pbrMetallicRoughness.roughnessFactor = 0.8;
    model_.materials.push_back(std::move(material));
    return static_cast<int>(model_.materials.size()) - 1;
  }

  template <class Number>
  int add(const std::vector<Number>& numbers, int component, int type, std::size_t per_element, int target = 0) {
    const int view = add_view(numbers.data(), numbers.size() * sizeof(Number), target);
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = numbers.size() / per_element;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  /// Positions, or differences of them, with their bounds, which the format demands.
  int add_positions(const Eigen::Matrix3Xf& points) {
    const std::vector<float> numbers(points.data(), points.data() + points.size());
    const int accessor = add(numbers, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 3, TINYGLTF_TARGET_ARRAY_BUFFER);
    bound(accessor, points);
    return accessor;
  }

  int add_times(const std::vector<float>& times) {
    const int accessor = add(times, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 1);
    model_.accessors[accessor].minValues = {times.front()};
    model_.accessors[accessor].maxValues = {times.back()};
    return accessor;
  }

  int add_node(const std::string& name, tinygltf::Mesh mesh) {
    mesh.name = name;
    model_.meshes.push_back(std::move(mesh));
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model_.meshes.size()) - 1;
    model_.nodes.push_back(std::move(node));
    const int number = static_cast<int>(model_.nodes.size()) - 1;
    model_.scenes[0].nodes.push_back(number);
    return number;
  }

  void animate(int node, const std::string& path, int times, int values) {
    tinygltf::Animation& animation = model_.animations[0];
    tinygltf::AnimationSampler sampler;
    sampler.input = times;
    sampler.output = values;
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation.samplers.push_back(std::move(sampler));
    animation.channels.push_back(std::move(channel));
  }

  [[nodiscard]] std::string bytes() {
    if (model_.animations[0].channels.empty()) model_.animations.clear();
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, stream, false, true))
      throw FileError("make", "animation.glb", "glTF was not written");
    return std::move(stream).str();
  }

 private:
  int add_view(const void* data, std::size_t size, int target) {
    std::vector<unsigned char>& buffer = model_.buffers[0].data;
    buffer.resize((buffer.size() + kAlignment - 1) / kAlignment * kAlignment);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = size;
    view.target = target;
    buffer.resize(buffer.size() + size);
    if (size > 0) std::memcpy(buffer.data() + view.byteOffset, data, size);
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  void bound(int accessor, const Eigen::Matrix3Xf& points) {
    for (int axis = 0; axis < 3; ++axis) {
      model_.accessors[accessor].minValues.push_back(points.row(axis).minCoeff());
      model_.accessors[accessor].maxValues.push_back(points.row(axis).maxCoeff());
    }
  }

  tinygltf::Model model_;
};

GltfExporter::GltfExporter(ExportedRun run)
    : run_(std::move(run)),
      shapes_(shapes_of(run_.model)),
      targets_(shapes_.size()),
      target_times_(shapes_.size()),
      poses_(shapes_.size()) {}

/// Every so many frames are targets.
int GltfExporter::interval(Index vertices) const {
  const double room = kMostBytes / (3.0 * sizeof(float) * std::max(vertices, Index{1}));
  const int most = static_cast<int>(std::clamp(room - 1.0, 1.0, kMostTargets - 1.0));
  return std::max(1, (run_.frames - 1 + most - 1) / most);
}

std::vector<std::string> GltfExporter::losses(bool tears) const {
  std::vector<std::string> losses;
  for (const ExportedShape& shape : shapes_) {
    const Index count = shape.body != kNone ? static_cast<Index>(run_.model.bodies[shape.body].particle_of.size())
                                            : static_cast<Index>(run_.model.obstacles[shape.obstacle].mesh.vertices.cols());
    const bool morphs = shape.body != kNone || run_.model.obstacles[shape.obstacle].motion == ObstacleMotion::deforming;
    if (const int every = interval(count); morphs && every > 1) {
      losses.push_back("animation.glb has every " + std::to_string(every) + ". frame of " + shape.name +
                       ": a body has at most 256 morph targets and 100 MB of them");
    }
  }
  if (tears) losses.emplace_back("faces that tear stay in animation.glb");
  if (has_groups(run_.model)) losses.emplace_back("animation.glb has no groups of faces");
  if (has_materials(run_.model)) losses.emplace_back("animation.glb has the colours of materials (Kd), and no textures");
  return losses;
}

std::vector<ExportedFile> GltfExporter::frame(const ExportedFrame& frame) {
  times_.push_back(static_cast<float>(frame.state.time));
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const ExportedShape& shape = shapes_[k];
    const ObstacleMotion motion = shape.body != kNone ? ObstacleMotion::deforming : run_.model.obstacles[shape.obstacle].motion;
    if (motion == ObstacleMotion::rigid) {
      poses_[k].push_back(frame.state.poses[shape.obstacle]);
      if (frame.number == 1) targets_[k].push_back(run_.model.obstacles[shape.obstacle].mesh.vertices.cast<float>());
      continue;
    }
    if (motion == ObstacleMotion::fixed && frame.number > 1) continue;
    const Points vertices = vertices_of(run_.model, shape, frame.state);
    const bool is_target = (frame.number - 1) % interval(static_cast<Index>(vertices.cols())) == 0;
    if (!is_target && frame.number != run_.frames) continue;
    targets_[k].push_back(vertices.cast<float>());
    target_times_[k].push_back(times_.back());
  }
  return {};
}

std::vector<ExportedFile> GltfExporter::end(int /*frames*/) {
  Builder builder;
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    if (targets_[k].empty() || targets_[k].front().cols() == 0) continue;
    tinygltf::Mesh mesh;
    mesh.primitives = primitives(k, builder);
    if (mesh.primitives.empty()) continue;
    mesh.weights.assign(targets_[k].size() - 1, 0.0);
    const int node = builder.add_node(shapes_[k].name, std::move(mesh));
    if (targets_[k].size() > 1) animate_targets(k, node, builder);
    if (!poses_[k].empty()) animate_pose(k, node, builder);
  }
  return {{"animation.glb", builder.bytes()}};
}

/// Of the faces of each material, and of the lines.
std::vector<tinygltf::Primitive> GltfExporter::primitives(std::size_t k, Builder& builder) const {
  const ExportedShape& shape = shapes_[k];
  const SplitVertices vertices = split(shape.faces, static_cast<Index>(targets_[k].front().cols()));
  tinygltf::Primitive shared;
  const Eigen::Matrix3Xf base = targets_[k].front()(Eigen::all, vertices.vertex_of);
  shared.attributes["POSITION"] = builder.add_positions(base);
  if (!vertices.texcoords.empty()) {
    std::vector<float> uv;
    for (const std::array<float, 2>& at : vertices.texcoords) uv.insert(uv.end(), at.begin(), at.end());
    shared.attributes["TEXCOORD_0"] =
        builder.add(uv, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, 2, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  for (std::size_t t = 1; t < targets_[k].size(); ++t) {
    const Eigen::Matrix3Xf moved = targets_[k][t](Eigen::all, vertices.vertex_of) - base;
    shared.targets.push_back({{"POSITION", builder.add_positions(moved)}});
  }
  std::vector<tinygltf::Primitive> all;
  const bool is_body = shape.body != kNone;
  const std::array<double, 4>& plain = is_body ? kBodyColour : kObstacleColour;
  const auto add = [&](const std::vector<std::uint32_t>& corners, int mode, const std::string& material,
                       const std::array<double, 4>& colour) {
    if (corners.empty()) return;
    tinygltf::Primitive& primitive = all.emplace_back(shared);
    primitive.mode = mode;
    primitive.material = builder.add_material(material, colour);
    primitive.indices =
        builder.add(corners, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, 1, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  };
  const Index faces = shape.faces.face_count();
  if (!is_body || run_.model.bodies[shape.body].face_materials.empty()) {
    add(triangles(shape.faces, vertices, 0, faces), TINYGLTF_MODE_TRIANGLES, shape.name, plain);
  } else {
    const RecordedBody& body = run_.model.bodies[shape.body];
    std::map<std::string, std::array<double, 3>> colours;
    if (body.source) colours = diffuse_colours(body.source->materials);
    for (std::size_t m = 0; m < body.face_materials.size(); ++m) {
      const Index end = m + 1 < body.face_material_begin.size() ? body.face_material_begin[m + 1] : faces;
      const auto found = colours.find(body.face_materials[m]);
      const auto colour =
          found == colours.end() ? plain : std::array{found->second[0], found->second[1], found->second[2], plain[3]};
      add(triangles(shape.faces, vertices, body.face_material_begin[m], end), TINYGLTF_MODE_TRIANGLES, body.face_materials[m],
          colour);
    }
  }
  std::vector<std::uint32_t> ends;
  for (const Index end : shape.lines.reshaped()) ends.push_back(static_cast<std::uint32_t>(end));
  add(ends, TINYGLTF_MODE_LINE, shape.name + " lines", plain);
  return all;
}

/// At the time of each target its weight is 1.
void GltfExporter::animate_targets(std::size_t k, int node, Builder& builder) const {
  const std::size_t targets = targets_[k].size() - 1;
  std::vector<float> weights(targets * target_times_[k].size(), 0.0F);
  for (std::size_t t = 1; t < target_times_[k].size(); ++t) weights[t * targets + t - 1] = 1.0F;
  builder.animate(node, "weights", builder.add_times(target_times_[k]),
                  builder.add(weights, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 1));
}

void GltfExporter::animate_pose(std::size_t k, int node, Builder& builder) const {
  std::vector<float> positions;
  std::vector<float> rotations;
  Eigen::Quaterniond before = Eigen::Quaterniond::Identity();
  for (const RigidTransform& pose : poses_[k]) {
    const Vector3 position = pose.translation();
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(position[axis]));
    Eigen::Quaterniond rotation(pose.rotation());
    if (rotation.dot(before) < 0.0) rotation.coeffs() *= -1.0;  // the shorter way between two frames
    before = rotation;
    for (int axis = 0; axis < 4; ++axis) rotations.push_back(static_cast<float>(rotation.coeffs()[axis]));
  }
  const int times = builder.add_times(times_);
  builder.animate(node, "translation", times, builder.add(positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 3));
  builder.animate(node, "rotation", times, builder.add(rotations, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4, 4));
}

}  // namespace sprung
