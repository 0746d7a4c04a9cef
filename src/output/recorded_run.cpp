#include "output/recorded_run.h"

#include "base/error.h"
#include "base/files/file_pattern.h"
#include "geometry/obj_source/vertex_lines.h"
#include "output/record/array_block.h"
#include "output/record/record_format.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

// A scene has fewer levels than 64, and functions that copy and write JSON call themselves once a level.
constexpr int kMostLevels = 66;

constexpr const char* kRemedy = "give the folder of a run, as sprung run --out writes it";
constexpr const char* kObstacles = "obstacles/";
constexpr const char* kFrameRemedy = "restore this frame, or run the scene again";

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& key, const std::string& rule,
                       const char* remedy = kRemedy) {
  throw InputError({file.string(), key, "", rule, remedy});
}

[[noreturn]] void fail_to_read(const std::filesystem::path& file, const std::string& reason, const char* remedy = kRemedy) {
  throw FileError("read", file.string(), reason + "; " + remedy);
}

/// Requires that the summary has the key with a value of this type.
template <class Value>
Value read(const Json& summary, const char* key, const std::filesystem::path& file) {
  const auto found = summary.find(key);
  try {
    if (found != summary.end()) return found->get<Value>();
  } catch (const Json::exception&) {
    fail(file, key, "has a value of the wrong type");
  }
  fail(file, key, "is missing");
}

/// Requires a whole number.
int read_count(const Json& summary, const char* key, const std::filesystem::path& file) {
  const auto number = read<double>(summary, key, file);
  if (!(number >= 0.0 && number <= std::numeric_limits<int>::max()) || number != std::floor(number)) {
    fail(file, key, "must be a whole number");
  }
  return static_cast<int>(number);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char letter : line) {
    if (letter == ',') {
      fields.emplace_back();
    } else if (letter != '\r') {
      fields.back() += letter;
    }
  }
  return fields;
}

double number_of(const std::string& field) {
  double number = 0.0;
  const auto end = std::from_chars(field.data(), field.data() + field.size(), number);
  return end.ec == std::errc{} && end.ptr == field.data() + field.size() ? number : std::numeric_limits<double>::quiet_NaN();
}

std::string name_of(const std::string& pattern) {
  const std::string file = std::filesystem::path(pattern).filename().string();
  return file.substr(0, file.find('.'));
}

bool has_a_file_per_frame(const std::string& pattern) { return pattern.find('#') != std::string::npos; }

/// A mesh as a body whose vertices are particles from `first` on.
RecordedBody body_of(const std::string& name, PolygonMesh mesh, Index first) {
  RecordedBody body{.name = name,
                    .first_particle = first,
                    .particle_count = static_cast<Index>(mesh.vertices.cols()),
                    .particle_of = std::vector<Index>(static_cast<std::size_t>(mesh.vertices.cols())),
                    .faces = std::move(mesh.faces),
                    .lines = std::move(mesh.lines)};
  std::iota(body.particle_of.begin(), body.particle_of.end(), first);
  return body;
}

}  // namespace

RecordedRun::RecordedRun(std::filesystem::path folder, RunParts parts) : folder_(std::move(folder)) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder_, ignored)) fail_to_read(folder_, "it is no folder");
  read_summary(parts);
  read_diagnostics();
}

void RecordedRun::read_summary(RunParts parts) {
  const std::filesystem::path file = folder_ / kRunSummaryFile;
  std::error_code error;
  const auto kind = std::filesystem::status(file, error).type();
  if (kind == std::filesystem::file_type::not_found) fail_to_read(file, "it is missing, so this is not the folder of a run");
  if (error) fail_to_read(file, error.message());
  if (kind != std::filesystem::file_type::regular) fail_to_read(file, "it is not a regular file");
  errno = 0;
  std::ifstream stream(file);
  if (!stream) fail_to_read(file, std::strerror(errno));
  const Json summary = Json::parse(
      stream,
      [&](int level, Json::parse_event_t, const Json&) {
        if (level > kMostLevels) fail(file, "", "is nested too deeply");
        return true;
      },
      false);
  const auto patterns = files_of_run(file);
  if (!patterns) fail(file, "", "is not the summary of a run");
  frames_ = read_count(summary, "frames_written", file);
  frame_rate_ = read<double>(summary, "frame_rate", file);
  step_ = read<double>(summary, "step", file);
  steps_per_frame_ = read_count(summary, "steps_per_frame", file);
  warnings_ = read<std::vector<std::string>>(summary, "warnings", file);
  if (summary.contains("scene") && summary["scene"].is_object()) scene_ = summary["scene"].dump();
  if (summary.contains("scene_file")) title_ = read<std::string>(summary, "scene_file", file);
  if (title_.empty()) title_ = std::filesystem::weakly_canonical(folder_).filename().string();
  if (frames_ < 1) fail(file, "frames_written", "is 0: the run has no frame to show");
  if (!(frame_rate_ > 0.0) || !(step_ > 0.0) || steps_per_frame_ < 1)
    fail(file, "frame_rate", "and the steps must be greater than 0");
  if (parts == RunParts::diagnostics) return;
  if (std::filesystem::symlink_status(folder_ / kRecordFile, error).type() != std::filesystem::file_type::not_found) {
    const bool names_record = summary.contains("record") && summary["record"].is_string();
    read_record(frames_, names_record ? summary["record"].get<std::string>() : "");
  } else {
    read_obj_model(*patterns);
  }
  if (summary.contains("torn_faces")) read_torn_faces(summary["torn_faces"].dump());
}

void RecordedRun::read_record(int frames_written, const std::string& fingerprint) {
  record_.emplace(folder_ / kRecordFile);
  if (!fingerprint.empty() && fingerprint != record_->fingerprint()) {
    fail(folder_ / kRecordFile, "", "is the record of another run", kDamagedRecordRemedy);
  }
  frames_ = std::min(frames_written, record_->frames());
  if (frames_ < 1) fail(folder_ / kRecordFile, "", "has no whole frame", kDamagedRecordRemedy);
  if (frames_ < frames_written) {
    missing_ = (folder_ / kRecordFile).string() + " ends after frame " + std::to_string(frames_) + " of " +
               std::to_string(frames_written) + ": later frames are missing; copy the file again, or run the scene again";
  }
}

/// Leaves out bodies and faces that the model does not have.
void RecordedRun::read_torn_faces(const std::string& torn_faces) {
  const std::filesystem::path file = folder_ / kRunSummaryFile;
  for (const Json& entry : Json::parse(torn_faces)) {
    TornFaces torn;  // filled member by member, see record_reader.cpp
    torn.body = read<std::string>(entry, "body", file);
    torn.frame = read_count(entry, "frame", file);
    torn.faces = read<std::vector<Index>>(entry, "faces", file);
    const auto body = std::ranges::find(model().bodies, torn.body, &RecordedBody::name);
    if (body == model().bodies.end()) continue;
    std::erase_if(torn.faces, [&](Index face) { return face < 0 || face >= body->faces.face_count(); });
    torn_faces_.push_back(std::move(torn));
  }
}

void RecordedRun::read_obj_model(const std::vector<std::string>& patterns) {
  RecordedModel& model = model_of_obj_;
  for (const std::string& pattern : patterns) {
    if (!pattern.ends_with(".obj")) continue;
    const auto has_beside = [&](const char* ending) {
      const std::string name = pattern.substr(0, pattern.size() - std::string(".obj").size()) + ending;
      return std::ranges::find(patterns, name) != patterns.end();
    };
    if (has_beside(".pc2") || has_beside(".mdd")) continue;  // the first frame, beside a point cache
    const bool is_obstacle = pattern.starts_with(kObstacles);
    const bool changes = has_a_file_per_frame(pattern);
    if (!stays_inside(pattern)) fail(folder_ / kRunSummaryFile, "files", "lead out of the folder: " + pattern);
    if (!is_obstacle && !changes) fail(folder_ / kRunSummaryFile, "files", "name no file of each frame: " + pattern);
    PolygonMesh mesh = read_obj(folder_ / fill_pattern(pattern, 1));
    if (is_obstacle) {
      model.obstacles.push_back({.name = name_of(pattern),
                                 .motion = changes ? ObstacleMotion::deforming : ObstacleMotion::fixed,
                                 .mesh = {mesh.vertices, triangulate(mesh.faces)}});
      obstacle_patterns_.push_back(pattern);
    } else {
      model.bodies.push_back(body_of(name_of(pattern), std::move(mesh), model.particle_count));
      model.particle_count += model.bodies.back().particle_count;
      body_patterns_.push_back(pattern);
    }
  }
  if (model.bodies.empty()) {
    fail(folder_, "", std::string("has neither ") + kRecordFile + " nor OBJ files, so there is nothing to show",
         "run the scene again; \"output\": { \"record\": false } leaves out record.bin");
  }
  missing_ = folder_.string() + " has no " + kRecordFile +
             ": springs, pins, velocities and contact are missing; run the scene again to have them";
}

/// A run without diagnostics is shown without plots.
void RecordedRun::read_diagnostics() {
  std::ifstream stream(folder_ / "diagnostics.csv");
  std::string line;
  if (!std::getline(stream, line)) return;
  diagnostics_.columns = fields_of(line);
  while (static_cast<int>(diagnostics_.rows.size()) < frames_ && std::getline(stream, line)) {
    std::vector<double> row;
    for (const std::string& field : fields_of(line)) row.push_back(number_of(field));
    row.resize(diagnostics_.columns.size(), std::numeric_limits<double>::quiet_NaN());
    diagnostics_.rows.push_back(std::move(row));
  }
}

RecordedFrame RecordedRun::frame(int number) const { return record_ ? record_->frame(number) : frame_of_obj(number); }

std::vector<BrokenSprings> RecordedRun::broken_springs() const {
  std::vector<BrokenSprings> all;
  std::vector<char> before(static_cast<std::size_t>(model().springs.ends.cols()));
  for (int frame = 1; record_ && frame <= frames_; ++frame) {
    const std::vector<char> now = record_->broken(frame);
    if (now.empty()) break;  // none can break
    BrokenSprings broken{.frame = frame, .springs = {}};
    for (std::size_t s = 0; s < now.size(); ++s) {
      if (now[s] != 0 && before[s] == 0) broken.springs.push_back(static_cast<Index>(s));
    }
    if (!broken.springs.empty()) all.push_back(std::move(broken));
    before = now;
  }
  return all;
}

RecordedFrame RecordedRun::frame_of_obj(int number) const {
  const RecordedModel& model = model_of_obj_;
  RecordedFrame frame{.time = (number - 1) / frame_rate_,
                      .positions = Points(3, model.particle_count),
                      .states = std::vector<std::uint8_t>(static_cast<std::size_t>(model.particle_count)),
                      .poses = std::vector<RigidTransform>(model.obstacles.size(), RigidTransform::Identity())};
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const RecordedBody& body = model.bodies[b];
    frame.positions.middleCols(body.first_particle, body.particle_count) =
        obj_positions(body_patterns_[b], number, body.particle_count);
  }
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    if (model.obstacles[k].motion == ObstacleMotion::fixed) continue;
    frame.deformed.push_back(obj_positions(obstacle_patterns_[k], number, model.obstacles[k].mesh.vertices.cols()));
  }
  return frame;
}

/// The positions of the file of a frame [m], 3 x `count`.
Points RecordedRun::obj_positions(const std::string& pattern, int frame, Eigen::Index count) const {
  const std::filesystem::path file = folder_ / fill_pattern(pattern, frame);
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    fail_to_read(file, "it is not a regular file", kFrameRemedy);
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_to_read(file, "it is missing", kFrameRemedy);
  std::ostringstream text;
  text << stream.rdbuf();
  Points positions = read_vertex_lines(text.str());
  if (positions.cols() != count) {
    fail(file, "", "has " + std::to_string(positions.cols()) + " vertices, the first frame has " + std::to_string(count),
         kFrameRemedy);
  }
  if (!positions.allFinite()) fail(file, "", "has a position that is not finite", kFrameRemedy);
  return positions;
}

}  // namespace sprung
