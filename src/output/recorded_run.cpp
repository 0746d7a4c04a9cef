#include "output/recorded_run.h"

#include "base/error.h"
#include "output/file_pattern.h"
#include "output/obj_sequence.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
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

/// Requires that the record has the key with a value of this type.
template <class Value>
Value read(const Json& record, const char* key, const std::filesystem::path& file) {
  const auto found = record.find(key);
  try {
    if (found != record.end()) return found->get<Value>();
  } catch (const Json::exception&) {
    fail(file, key, "has a value of the wrong type");
  }
  fail(file, key, "is missing");
}

/// Requires a whole number.
int read_count(const Json& record, const char* key, const std::filesystem::path& file) {
  const auto number = read<double>(record, key, file);
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

}  // namespace

RecordedRun::RecordedRun(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder_, ignored)) fail(folder_, "", "is no folder");
  read_record();
  read_diagnostics();
}

void RecordedRun::read_record() {
  const std::filesystem::path file = folder_ / kRunRecordFile;
  std::ifstream stream(file);
  if (!stream) fail(file, "", "is missing, so this is not the folder of a run");
  const Json record = Json::parse(
      stream,
      [&](int level, Json::parse_event_t, const Json&) {
        if (level > kMostLevels) fail(file, "", "is nested too deeply");
        return true;
      },
      false);
  const auto patterns = files_of_run(file);
  if (!patterns) fail(file, "", "is not the record of a run");
  frames_ = read_count(record, "frames_written", file);
  frame_rate_ = read<double>(record, "frame_rate", file);
  step_ = read<double>(record, "step", file);
  steps_per_frame_ = read_count(record, "steps_per_frame", file);
  warnings_ = read<std::vector<std::string>>(record, "warnings", file);
  if (record.contains("scene") && record["scene"].is_object()) scene_ = record["scene"].dump();
  if (frames_ < 1) fail(file, "frames_written", "is 0: the run has no frame to show");
  if (!(frame_rate_ > 0.0) || !(step_ > 0.0) || steps_per_frame_ < 1)
    fail(file, "frame_rate", "and the steps must be greater than 0");
  read_meshes(*patterns);
  if (record.contains("torn_faces")) read_torn_faces(record["torn_faces"].dump());
}

/// Faces of other bodies, and of numbers that a body does not have, are left out.
void RecordedRun::read_torn_faces(const std::string& record) {
  const std::filesystem::path file = folder_ / kRunRecordFile;
  for (const Json& entry : Json::parse(record)) {
    TornFaces torn{.body = read<std::string>(entry, "body", file),
                   .frame = read_count(entry, "frame", file),
                   .faces = read<std::vector<Index>>(entry, "faces", file)};
    const auto body = std::ranges::find(bodies_, torn.body, &RecordedMesh::name);
    if (body == bodies_.end()) continue;
    std::erase_if(torn.faces, [&](Index face) { return face < 0 || face >= body->first.faces.face_count(); });
    torn_faces_.push_back(std::move(torn));
  }
}

void RecordedRun::read_meshes(const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    if (!pattern.ends_with(".obj")) continue;
    if (!stays_inside(pattern)) fail(folder_ / kRunRecordFile, "files", "lead out of the folder: " + pattern);
    if (!pattern.starts_with(kObstacles) && fill_pattern(pattern, 1) == pattern) {
      fail(folder_ / kRunRecordFile, "files", "name no file of each frame: " + pattern);
    }
    RecordedMesh mesh{.name = name_of(pattern), .pattern = pattern, .first = {}};
    mesh.first = read_obj(folder_ / (mesh.changes() ? fill_pattern(pattern, 1) : pattern));
    (pattern.starts_with(kObstacles) ? obstacles_ : bodies_).push_back(std::move(mesh));
  }
  if (bodies_.empty()) fail(folder_ / kRunRecordFile, "files", "name no body");
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

Points RecordedRun::positions(const RecordedMesh& mesh, int frame) const {
  if (!mesh.changes()) return mesh.first.vertices;
  const std::filesystem::path file = folder_ / fill_pattern(mesh.pattern, frame);
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    fail(file, "", "is not a regular file", kFrameRemedy);
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "", "is missing", kFrameRemedy);
  std::ostringstream text;
  text << stream.rdbuf();
  Points positions = read_vertex_lines(text.str());
  if (positions.cols() != mesh.first.vertices.cols()) {
    fail(file, "",
         "has " + std::to_string(positions.cols()) + " vertices, the first frame has " + std::to_string(mesh.first.vertices.cols()),
         kFrameRemedy);
  }
  if (!positions.allFinite()) fail(file, "", "has a position that is not finite", kFrameRemedy);
  return positions;
}

}  // namespace sprung
