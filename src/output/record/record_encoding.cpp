#include "output/record/record_encoding.h"

#include "base/files/fingerprint.h"
#include "output/record/array_block.h"
#include "output/record/record_format.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

Json table_of(const ArrayTable& table) {
  Json json = Json::object();
  for (const auto& [name, entry] : table) {
    json[name] = {{"type", kNumberTypeNames[static_cast<std::size_t>(entry.type)]},
                  {"shape", {entry.rows, entry.columns}},
                  {"offset", entry.offset}};
  }
  return json;
}

/// Infinity has no number in JSON.
Json or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json or_null(Index index) { return index == kNone ? Json() : Json(index); }

/// Of a body's file, without its bytes, which are arrays.
Json source_json(const ObjSource& source) {
  Json libraries = Json::array();
  Json textures = Json::array();
  for (const MaterialFile& file : source.materials.files) (file.is_texture ? textures : libraries).push_back(file.place);
  return {{"normals", source.file.writes_normals()}, {"libraries", libraries}, {"textures", textures}};
}

Json body_json(const RecordedBody& body) {
  return {{"name", body.name},
          {"material", body.material},
          {"first_particle", body.first_particle},
          {"particle_count", body.particle_count},
          {"groups", body.faces.groups},
          {"group_begin", body.faces.group_begin},
          {"face_materials", body.face_materials},
          {"face_material_begin", body.face_material_begin},
          {"obj", body.source ? source_json(*body.source) : Json()}};
}

Json attachment_json(const Attachment& attachment) {
  Json second;
  if (const auto* ends = std::get_if<ParticleEnds>(&attachment.second)) second = {{"particles", ends->particles}};
  if (const auto* surface = std::get_if<SurfaceEnd>(&attachment.second)) second = {{"body", surface->body}};
  if (const auto* obstacle = std::get_if<ObstacleEnd>(&attachment.second)) second = {{"obstacle", obstacle->obstacle}};
  return {{"name", attachment.name},
          {"particles", attachment.particles},
          {"second", second},
          {"stiffness", attachment.stiffness ? Json(*attachment.stiffness) : Json()},
          {"damping", attachment.damping},
          {"rest_length", attachment.rest_length ? Json(*attachment.rest_length) : Json()},
          {"break_force", or_null(attachment.break_force)},
          {"from", attachment.from},
          {"until", or_null(attachment.until)}};
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// The file of a body with all vertices at 0, from which the same template is made, and its libraries.
void add_source(const ObjSource& source, std::size_t body, ArrayBlock& block) {
  const Points nowhere = Points::Zero(3, source.file.vertex_count());
  block.add(body_arrays(body) + "obj", bytes_of(source.file.text(nowhere, nowhere)));
  std::size_t library = 0;
  for (const MaterialFile& file : source.materials.files) {
    if (!file.is_texture) block.add(library_array(body, library++), bytes_of(content_of(file)));
  }
}

ArrayBlock arrays_of(const RecordedModel& model) {
  ArrayBlock block;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const RecordedBody& body = model.bodies[b];
    block.add(body_arrays(b) + "particle_of", body.particle_of);
    block.add(body_arrays(b) + "corner_begin", body.faces.corner_begin);
    block.add(body_arrays(b) + "vertex", body.faces.vertex);
    block.add(body_arrays(b) + "texcoord", body.faces.texcoord);
    std::vector<double> texcoords;
    for (const std::array<double, 2>& uv : body.faces.texcoords) texcoords.insert(texcoords.end(), uv.begin(), uv.end());
    block.add(body_arrays(b) + "texcoords", texcoords);
    block.add(body_arrays(b) + "lines", body.lines);
    if (body.source) add_source(*body.source, b, block);
  }
  block.add("springs/ends", model.springs.ends);
  block.add("springs/rest_lengths", model.springs.rest_lengths);
  std::vector<std::uint8_t> kinds;
  for (const SpringKind kind : model.springs.kinds) kinds.push_back(static_cast<std::uint8_t>(kind));
  block.add("springs/kinds", kinds);
  if (!model.springs.stiffness.empty()) {
    block.add("springs/stiffness", model.springs.stiffness);
    block.add("springs/damping", model.springs.damping);
  }
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    const std::string name = obstacle_arrays(k);
    block.add(name + "vertices", model.obstacles[k].mesh.vertices);
    block.add(name + "triangles", model.obstacles[k].mesh.triangles);
  }
  return block;
}

Json model_json(const RecordedModel& model) {
  Json bodies = Json::array();
  for (const RecordedBody& body : model.bodies) bodies.push_back(body_json(body));
  Json pins = Json::array();
  for (const RecordedPin& pin : model.pins) {
    pins.push_back({{"name", pin.name},
                    {"particles", pin.particles},
                    {"obstacle", or_null(pin.obstacle)},
                    {"from", pin.from},
                    {"until", or_null(pin.until)}});
  }
  Json attachments = Json::array();
  for (const Attachment& attachment : model.attachments) attachments.push_back(attachment_json(attachment));
  Json obstacles = Json::array();
  for (const RecordedObstacle& obstacle : model.obstacles) {
    obstacles.push_back({{"name", obstacle.name}, {"motion", kObstacleMotionNames[static_cast<std::size_t>(obstacle.motion)]}});
  }
  return {{"particle_count", model.particle_count},
          {"bodies", bodies},
          {"pins", pins},
          {"attachments", attachments},
          {"obstacles", obstacles}};
}

std::vector<std::uint8_t> packed(const std::vector<char>& flags) {
  std::vector<std::uint8_t> bits((flags.size() + 7) / 8);
  for (std::size_t k = 0; k < flags.size(); ++k) {
    if (flags[k] != 0) bits[k / 8] = static_cast<std::uint8_t>(bits[k / 8] | (1U << (k % 8)));
  }
  return bits;
}

ArrayBlock arrays_of(const RecordedFrame& frame) {
  ArrayBlock block;
  block.add("time", std::vector<double>{frame.time});
  block.add("positions", frame.positions);
  block.add("velocities", frame.velocities);
  block.add("states", frame.states);
  if (!frame.broken.empty()) block.add("broken", packed(frame.broken));
  std::vector<double> poses;
  for (const RigidTransform& pose : frame.poses) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) poses.push_back(pose.matrix()(row, column));
    }
  }
  block.add("poses", poses);
  for (std::size_t k = 0; k < frame.deformed.size(); ++k) block.add(deformed_array(k), frame.deformed[k]);
  return block;
}

void append_u64(std::string& bytes, std::uint64_t number) {
  std::array<char, sizeof(number)> raw{};
  std::memcpy(raw.data(), &number, sizeof(number));
  bytes.append(raw.data(), raw.size());
}

}  // namespace

std::string encode_frame(const RecordedFrame& frame) { return arrays_of(frame).bytes(); }

std::string fingerprint(std::string_view head) {
  const std::uint64_t hash = fingerprint_of(head);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += kDigits[(hash >> static_cast<unsigned>(shift)) & 15U];
  return digits;
}

std::string encode_head(const RecordedModel& model, const RecordedFrame& like) {
  const ArrayBlock arrays = arrays_of(model);
  const ArrayBlock frame = arrays_of(like);
  Json json = model_json(model);
  json["arrays"] = table_of(arrays.table());
  json["array_bytes"] = arrays.bytes().size();
  json["frame_arrays"] = table_of(frame.table());
  json["frame_bytes"] = frame.bytes().size();
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize(aligned(text.size()), ' ');
  std::string bytes(kRecordMagic);
  append_u64(bytes, kRecordVersion);
  append_u64(bytes, text.size());
  return bytes + text + arrays.bytes();
}

}  // namespace sprung
