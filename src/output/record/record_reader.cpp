#include "output/record/record_reader.h"

#include "base/error.h"
#include "base/files/file_pattern.h"
#include "output/record/array_block.h"
#include "output/record/record_encoding.h"
#include "output/record/record_format.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostLevels = 16;  // of the JSON text
constexpr Eigen::Index kPoseNumbers = 12;

std::vector<char> unpacked(const std::vector<std::uint8_t>& bits, Eigen::Index count) {
  std::vector<char> flags(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < flags.size(); ++k) flags[k] = static_cast<char>((bits[k / 8] >> (k % 8)) & 1U);
  return flags;
}

constexpr std::size_t kPrefixBytes = 24;  // magic, version, size of the JSON text

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& key, const std::string& rule,
                       const char* remedy = kDamagedRecordRemedy) {
  throw InputError({file.string(), key, "", rule, remedy});
}

[[noreturn]] void fail_to_read(const std::filesystem::path& file, const std::string& reason) {
  throw FileError("read", file.string(), reason + "; " + kDamagedRecordRemedy);
}

std::string read_bytes(const std::filesystem::path& file, std::uint64_t offset, std::uint64_t size) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_to_read(file, std::strerror(errno));
  std::string bytes(size, '\0');
  stream.seekg(static_cast<std::streamoff>(offset));
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) fail_to_read(file, "it became shorter");
  return bytes;
}

std::uint64_t u64_at(const std::string& bytes, std::size_t offset) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + offset, sizeof(number));
  return number;
}

ArrayTable read_table(const Json& json) {
  ArrayTable table;
  for (const auto& [name, entry] : json.items()) {
    const auto type = std::ranges::find(kNumberTypeNames, entry.at("type").get<std::string>());
    if (type == kNumberTypeNames.end()) throw std::out_of_range("type");
    const auto shape = entry.at("shape").get<std::array<std::uint64_t, 2>>();
    table[name] = {static_cast<NumberType>(type - kNumberTypeNames.begin()), shape[0], shape[1],
                   entry.at("offset").get<std::uint64_t>()};
  }
  return table;
}

double or_infinity(const Json& json) { return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>(); }

Index or_none(const Json& json) { return json.is_null() ? kNone : json.get<Index>(); }

// These fill members one by one: GCC 12 destroys a member of an aggregate twice if the initializer of a later one throws.

Attachment read_attachment(const Json& json) {
  Attachment attachment;
  json.at("name").get_to(attachment.name);
  json.at("particles").get_to(attachment.particles);
  const Json& second = json.at("second");
  if (second.contains("particles")) {
    attachment.second = ParticleEnds{second["particles"].get<std::vector<Index>>()};
  } else if (second.contains("body")) {
    attachment.second = SurfaceEnd{second["body"].get<Index>()};
  } else {
    attachment.second = ObstacleEnd{second.at("obstacle").get<Index>()};
  }
  if (!json.at("stiffness").is_null()) attachment.stiffness = json["stiffness"].get<double>();
  json.at("damping").get_to(attachment.damping);
  if (!json.at("rest_length").is_null()) attachment.rest_length = json["rest_length"].get<double>();
  attachment.break_force = or_infinity(json.at("break_force"));
  json.at("from").get_to(attachment.from);
  attachment.until = or_infinity(json.at("until"));
  return attachment;
}

/// Without the arrays.
RecordedBody read_body(const Json& json) {
  RecordedBody body;
  json.at("name").get_to(body.name);
  json.at("material").get_to(body.material);
  json.at("first_particle").get_to(body.first_particle);
  json.at("particle_count").get_to(body.particle_count);
  json.at("groups").get_to(body.faces.groups);
  json.at("group_begin").get_to(body.faces.group_begin);
  json.at("face_materials").get_to(body.face_materials);
  json.at("face_material_begin").get_to(body.face_material_begin);
  return body;
}

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// Whether files by these names stay in the folder of a body.
bool are_inside(const std::vector<std::string>& places) {
  return std::ranges::all_of(places, [](const std::string& place) { return stays_inside(place); });
}

/// The file of a body. Requires that all else of the body has been read.
void read_source(const Json& json, const ArrayBlockReader& arrays, std::size_t number, RecordedBody& body) {
  if (!json.contains("obj") || json["obj"].is_null()) return;  // contains: an older version
  const Json& obj = json["obj"];
  const auto libraries = obj.at("libraries").get<std::vector<std::string>>();
  const auto textures = obj.at("textures").get<std::vector<std::string>>();
  const std::string name = body_arrays(number) + "obj";
  if (!are_inside(libraries) || !are_inside(textures)) arrays.fail(name, "names files outside of the folder of its body");
  const auto normals = obj.at("normals").get<bool>() ? ObjTemplate::Normals::per_vertex : ObjTemplate::Normals::as_given;
  auto source = std::make_shared<ObjSource>(ObjSource{.file = ObjTemplate(text_of(arrays.bytes(name)), normals),
                                                      .particle_of = body.particle_of,
                                                      .faces = body.faces,
                                                      .lines = body.lines});
  if (source->file.vertex_count() != std::ssize(body.particle_of) || source->file.face_count() != body.faces.face_count()) {
    arrays.fail(name, "does not fit the vertices and faces");
  }
  for (Index& particle : source->particle_of) {
    particle -= body.first_particle;
    if (particle < 0 || particle >= body.particle_count) arrays.fail(name, "has a vertex of another body");
  }
  for (std::size_t k = 0; k < libraries.size(); ++k) {
    source->materials.files.push_back({.place = libraries[k], .text = text_of(arrays.bytes(library_array(number, k)))});
  }
  for (const std::string& texture : textures) source->materials.files.push_back({.place = texture, .is_texture = true});
  body.source = std::move(source);
}

RecordedPin read_pin(const Json& json) {
  RecordedPin pin;
  json.at("name").get_to(pin.name);
  json.at("particles").get_to(pin.particles);
  pin.obstacle = or_none(json.at("obstacle"));
  json.at("from").get_to(pin.from);
  pin.until = or_infinity(json.at("until"));
  return pin;
}

/// Without the arrays.
RecordedObstacle read_obstacle(const Json& json) {
  RecordedObstacle obstacle;
  json.at("name").get_to(obstacle.name);
  const auto motion = std::ranges::find(kObstacleMotionNames, json.at("motion").get<std::string>());
  if (motion == kObstacleMotionNames.end()) throw std::out_of_range("motion");
  obstacle.motion = static_cast<ObstacleMotion>(motion - kObstacleMotionNames.begin());
  return obstacle;
}

/// Without the arrays.
RecordedModel read_model(const Json& json) {
  RecordedModel model;
  json.at("particle_count").get_to(model.particle_count);
  for (const Json& body : json.at("bodies")) model.bodies.push_back(read_body(body));
  for (const Json& pin : json.at("pins")) model.pins.push_back(read_pin(pin));
  for (const Json& attachment : json.at("attachments")) model.attachments.push_back(read_attachment(attachment));
  for (const Json& obstacle : json.at("obstacles")) model.obstacles.push_back(read_obstacle(obstacle));
  return model;
}

template <class Indices>
bool are_below(const Indices& indices, Index count, Index least = 0) {
  return std::all_of(indices.begin(), indices.end(), [&](Index index) { return index >= least && index < count; });
}

bool are_below(const Triangles& columns, Index count) { return are_below(columns.reshaped(), count); }
bool are_below(const Edges& columns, Index count) { return are_below(columns.reshaped(), count); }

void read_arrays_of(const ArrayBlockReader& arrays, std::size_t number, Index particles, RecordedBody& body) {
  const std::string name = body_arrays(number);
  PolygonFaces& faces = body.faces;
  const auto require = [&](bool holds, const char* array, const char* rule) {
    if (!holds) arrays.fail(name + array, rule);
  };
  body.particle_of = arrays.indices(name + "particle_of");
  require(are_below(body.particle_of, particles), "particle_of", "names particles that do not exist");
  faces.corner_begin = arrays.indices(name + "corner_begin");
  faces.vertex = arrays.indices(name + "vertex");
  require(!faces.corner_begin.empty() && faces.corner_begin.front() == 0 && std::ranges::is_sorted(faces.corner_begin) &&
              faces.corner_begin.back() == std::ssize(faces.vertex),
          "corner_begin", "does not divide the corners into faces");
  for (Index face = 0; face < faces.face_count(); ++face) {
    require(faces.corner_begin[face + 1] - faces.corner_begin[face] >= 3, "corner_begin", "has a face of less than three corners");
  }
  const auto vertices = static_cast<Index>(body.particle_of.size());
  require(are_below(faces.vertex, vertices), "vertex", "names vertices that do not exist");
  const std::vector<double> texcoords = arrays.numbers(name + "texcoords");
  for (std::size_t k = 0; k + 1 < texcoords.size(); k += 2) faces.texcoords.push_back({texcoords[k], texcoords[k + 1]});
  faces.texcoord = arrays.indices(name + "texcoord");
  require((faces.texcoord.empty() || faces.texcoord.size() == faces.vertex.size()) &&
              are_below(faces.texcoord, static_cast<Index>(faces.texcoords.size()), kNone),
          "texcoord", "does not fit the corners");
  body.lines = arrays.edges(name + "lines");
  require(are_below(body.lines, vertices), "lines", "names vertices that do not exist");
  for (const auto* begin : {&faces.group_begin, &body.face_material_begin}) {
    require(are_below(*begin, faces.face_count() + 1), "corner_begin", "lacks faces of a group");
  }
}

void read_springs(const ArrayBlockReader& arrays, Index particles, RecordedSprings& springs) {
  springs.ends = arrays.edges("springs/ends");
  if (!are_below(springs.ends, particles)) arrays.fail("springs/ends", "names particles that do not exist");
  springs.rest_lengths = arrays.numbers("springs/rest_lengths");
  for (const auto& [name, values] :
       {std::pair("springs/stiffness", &springs.stiffness), std::pair("springs/damping", &springs.damping)}) {
    if (!arrays.has(name)) continue;  // of an older version
    *values = arrays.numbers(name);
    if (values->size() != static_cast<std::size_t>(springs.ends.cols())) arrays.fail(name, "does not fit the springs");
  }
  const std::vector<std::uint8_t> kinds = arrays.bytes("springs/kinds");
  const auto count = static_cast<std::size_t>(springs.ends.cols());
  const bool finite = std::ranges::all_of(springs.rest_lengths, [](double length) { return std::isfinite(length); });
  if (springs.rest_lengths.size() != count || !finite) arrays.fail("springs/rest_lengths", "does not fit the springs");
  const bool known = std::ranges::all_of(kinds, [](std::uint8_t kind) { return kind < kSpringKindNames.size(); });
  if (kinds.size() != count || !known) arrays.fail("springs/kinds", "does not fit the springs");
  for (const std::uint8_t kind : kinds) springs.kinds.push_back(static_cast<SpringKind>(kind));
}

/// Whether what the JSON text says of particles, bodies and obstacles fits together.
bool is_consistent(const RecordedModel& model) {
  const Index particles = model.particle_count;
  const auto bodies = static_cast<Index>(model.bodies.size());
  const auto obstacles = static_cast<Index>(model.obstacles.size());
  const auto is_range = [&](const RecordedBody& body) {
    return body.first_particle >= 0 && body.particle_count >= 0 && body.first_particle <= particles - body.particle_count &&
           body.faces.groups.size() == body.faces.group_begin.size() &&
           body.face_materials.size() == body.face_material_begin.size();
  };
  const auto fits = [&](const Attachment& attachment) {
    const auto* ends = std::get_if<ParticleEnds>(&attachment.second);
    const auto* surface = std::get_if<SurfaceEnd>(&attachment.second);
    const auto* obstacle = std::get_if<ObstacleEnd>(&attachment.second);
    return are_below(attachment.particles, particles) && (ends == nullptr || are_below(ends->particles, particles)) &&
           (surface == nullptr || (surface->body >= 0 && surface->body < bodies)) &&
           (obstacle == nullptr || (obstacle->obstacle >= 0 && obstacle->obstacle < obstacles));
  };
  return particles >= 0 && std::ranges::all_of(model.bodies, is_range) && std::ranges::all_of(model.attachments, fits) &&
         std::ranges::all_of(model.pins, [&](const RecordedPin& pin) {
           return are_below(pin.particles, particles) && (pin.obstacle == kNone || (pin.obstacle >= 0 && pin.obstacle < obstacles));
         });
}

/// An export writes folders by the names of bodies and obstacles.
bool has_folder_names(const RecordedModel& model) {
  return std::ranges::all_of(model.bodies, [](const RecordedBody& body) { return is_folder_name(body.name); }) &&
         std::ranges::all_of(model.obstacles, [](const RecordedObstacle& obstacle) { return is_folder_name(obstacle.name); });
}

}  // namespace

struct RecordReader::Contents {
  std::filesystem::path file;
  RecordedModel model;
  std::string fingerprint;
  ArrayTable frame_table;
  std::uint64_t frames_begin = 0;  // [bytes]
  std::uint64_t frame_bytes = 0;
  int frames = 0;

  /// Of a frame [bytes].
  [[nodiscard]] std::uint64_t begin_of(int frame) const {
    return frames_begin + static_cast<std::uint64_t>(frame - 1) * frame_bytes;
  }

  /// The JSON text of the head. Sets where the arrays begin.
  Json read_head(std::uint64_t size, std::uint64_t& arrays_begin) const {
    if (size < kPrefixBytes) fail(file, "", "is too short for a record of Sprung");
    const std::string prefix = read_bytes(file, 0, kPrefixBytes);
    if (!prefix.starts_with(kRecordMagic)) fail(file, "", "is no record of Sprung");
    const std::uint64_t version = u64_at(prefix, kRecordMagic.size());
    if (version != kRecordVersion) {
      fail(file, "",
           "has version " + std::to_string(version) + " of the format, and this Sprung reads version " +
               std::to_string(kRecordVersion),
           "use the Sprung that wrote it, or run the scene again");
    }
    const std::uint64_t text_bytes = u64_at(prefix, kRecordMagic.size() + sizeof(std::uint64_t));
    if (text_bytes > size - kPrefixBytes) fail(file, "", "ends within its head");
    arrays_begin = kPrefixBytes + text_bytes;
    const auto shallow = [&](int level, Json::parse_event_t, const Json&) {
      if (level > kMostLevels) fail(file, "", "is nested too deeply");
      return true;
    };
    return Json::parse(read_bytes(file, kPrefixBytes, text_bytes), shallow);
  }

  void read() {
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    if (error) fail_to_read(file, error.message());
    std::uint64_t arrays_begin = 0;
    const Json json = read_head(size, arrays_begin);
    const auto array_bytes = json.at("array_bytes").get<std::uint64_t>();
    if (array_bytes > size - arrays_begin) fail(file, "", "ends within its head");
    frames_begin = arrays_begin + array_bytes;
    fingerprint = sprung::fingerprint(read_bytes(file, 0, frames_begin));
    frame_bytes = json.at("frame_bytes").get<std::uint64_t>();
    if (frame_bytes == 0) fail(file, "frame_bytes", "must be greater than 0");
    frames = static_cast<int>(std::min<std::uint64_t>((size - frames_begin) / frame_bytes, std::numeric_limits<int>::max()));
    frame_table = read_table(json.at("frame_arrays"));
    model = read_model(json);
    if (!is_consistent(model)) fail(file, "", "names particles, bodies or obstacles that do not exist");
    if (!has_folder_names(model)) fail(file, "", "has a name that must name a folder and does not");
    read_arrays({read_bytes(file, arrays_begin, array_bytes), read_table(json.at("arrays")), file}, json.at("bodies"));
  }

  void read_arrays(const ArrayBlockReader& arrays, const Json& bodies) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      read_arrays_of(arrays, b, model.particle_count, model.bodies[b]);
      read_source(bodies[b], arrays, b, model.bodies[b]);
    }
    read_springs(arrays, model.particle_count, model.springs);
    for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
      const std::string name = obstacle_arrays(k);
      TriangleMesh& mesh = model.obstacles[k].mesh;
      mesh.vertices = arrays.points(name + "vertices");
      mesh.triangles = arrays.triangles(name + "triangles");
      if (!mesh.vertices.allFinite()) arrays.fail(name + "vertices", "has a number that is not finite");
      if (!are_below(mesh.triangles, static_cast<Index>(mesh.vertices.cols()))) {
        arrays.fail(name + "triangles", "names vertices that do not exist");
      }
    }
  }
};

RecordReader::RecordReader(std::filesystem::path file) {
  auto contents = std::make_unique<Contents>();
  contents->file = std::move(file);
  try {
    contents->read();
  } catch (const Json::exception& error) {
    fail(contents->file, "", std::string("has a damaged head: ") + error.what());
  } catch (const std::out_of_range& error) {
    fail(contents->file, error.what(), "has an unknown value in the head");
  }
  contents_ = std::move(contents);
}

RecordReader::~RecordReader() = default;
RecordReader::RecordReader(RecordReader&&) noexcept = default;
RecordReader& RecordReader::operator=(RecordReader&&) noexcept = default;

const RecordedModel& RecordReader::model() const { return contents_->model; }

const std::string& RecordReader::fingerprint() const { return contents_->fingerprint; }

int RecordReader::frames() const { return contents_->frames; }

std::vector<char> RecordReader::broken(int number) const {
  const auto found = contents_->frame_table.find("broken");
  if (found == contents_->frame_table.end()) return {};
  const ArrayEntry& entry = found->second;
  const Eigen::Index springs = model().springs.ends.cols();
  const auto bytes = static_cast<std::uint64_t>((springs + 7) / 8);
  if (entry.type != NumberType::u8 || entry.rows != 1 || entry.columns != bytes || entry.offset > contents_->frame_bytes ||
      bytes > contents_->frame_bytes - entry.offset) {
    fail(contents_->file, "broken", "does not fit the springs");
  }
  const std::string bits = read_bytes(contents_->file, contents_->begin_of(number) + entry.offset, bytes);
  return unpacked({bits.begin(), bits.end()}, springs);
}

RecordedFrame RecordReader::frame(int number) const {
  const RecordedModel& model = contents_->model;
  const ArrayBlockReader arrays(read_bytes(contents_->file, contents_->begin_of(number), contents_->frame_bytes),
                                contents_->frame_table, contents_->file);
  const auto require = [&](bool holds, const std::string& name, const char* rule) {
    if (!holds) arrays.fail("frame " + std::to_string(number) + ": " + name, rule);
  };
  RecordedFrame frame;
  const std::vector<double> time = arrays.numbers("time");
  require(time.size() == 1 && std::isfinite(time[0]), "time", "is no number");
  frame.time = time[0];
  frame.positions = arrays.points("positions");
  frame.velocities = arrays.points("velocities");
  frame.states = arrays.bytes("states");
  const Eigen::Index particles = model.particle_count;
  require(frame.positions.cols() == particles, "positions", "does not fit the particles");
  require(frame.velocities.cols() == particles, "velocities", "does not fit the particles");
  require(std::ssize(frame.states) == particles, "states", "does not fit the particles");
  constexpr const char* kNotFinite = "has a number that is not finite";
  require(frame.positions.allFinite(), "positions", kNotFinite);
  require(frame.velocities.allFinite(), "velocities", kNotFinite);
  if (arrays.has("broken")) {
    const std::vector<std::uint8_t> bits = arrays.bytes("broken");
    require(std::ssize(bits) == (model.springs.ends.cols() + 7) / 8, "broken", "does not fit the springs");
    frame.broken = unpacked(bits, model.springs.ends.cols());
  }
  const std::vector<double> poses = arrays.numbers("poses");
  require(poses.size() == kPoseNumbers * model.obstacles.size(), "poses", "does not fit the obstacles");
  require(std::ranges::all_of(poses, [](double entry) { return std::isfinite(entry); }), "poses", kNotFinite);
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    RigidTransform pose = RigidTransform::Identity();
    for (int i = 0; i < kPoseNumbers; ++i) pose.matrix()(i / 4, i % 4) = poses[kPoseNumbers * k + i];
    frame.poses.push_back(pose);
    if (model.obstacles[k].motion != ObstacleMotion::deforming) continue;
    const std::string name = deformed_array(frame.deformed.size());
    frame.deformed.push_back(arrays.points(name));
    require(frame.deformed.back().cols() == model.obstacles[k].mesh.vertices.cols(), name, "does not fit the obstacle");
    require(frame.deformed.back().allFinite(), name, kNotFinite);
  }
  return frame;
}

}  // namespace sprung
