#include "output/run_summary.h"

#include "base/error.h"
#include "base/files/file_writer.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

const std::string kProgram = "sprung";

// Frame 1 is the state at time 0.
constexpr std::int64_t kFirstComputedFrame = 2;

Json json_of(const StepAdjustment& adjustment) {
  const auto coordinates = [](const Vector3& point) { return Json::array({point.x(), point.y(), point.z()}); };
  return {{"body", adjustment.body},
          {"softened_springs", adjustment.softened},
          {"least_stiffness", adjustment.least_factor},
          {"heavier_particles", adjustment.heavier},
          {"added_mass", adjustment.added_mass},
          {"worst_edge", {coordinates(adjustment.from), coordinates(adjustment.to)}},
          {"length", adjustment.length}};
}

/// The strings of an array; nothing if it is none or holds anything else.
std::optional<std::vector<std::string>> strings_of(const Json& json, const char* key) {
  const Json array = json.value(key, Json());
  if (!array.is_array() || !std::ranges::all_of(array, [](const Json& each) { return each.is_string(); })) return std::nullopt;
  return array.get<std::vector<std::string>>();
}

bool is_run_summary(const Json& json) {
  return json.is_object() && json.value("program", Json()) == kProgram && strings_of(json, "files");
}

/// Lists the files of exports. Returns whether any was not listed before.
bool add_exports(const std::vector<std::string>& patterns, Json& json) {
  if (!json.contains("exports") || !json["exports"].is_array()) json["exports"] = Json::array();
  bool is_new = false;
  for (const std::string& pattern : patterns) {
    if (std::ranges::find(json["files"], Json(pattern)) != json["files"].end()) continue;
    json["files"].push_back(pattern);
    json["exports"].push_back(pattern);
    is_new = true;
  }
  return is_new;
}

}  // namespace

std::int64_t frame_of_step(std::int64_t step, std::int64_t steps_per_frame) {
  return 1 + (step + steps_per_frame - 1) / steps_per_frame;
}

struct RunSummary::Document {
  Json json;
  std::vector<std::string> warnings;  ///< of the facts
};

RunSummary::RunSummary(const RunFacts& facts, double step, const std::vector<std::string>& files)
    : document_(std::make_unique<Document>()) {
  document_->json = {{"program", kProgram},
                     {"version", SPRUNG_VERSION},
                     {"scene_file", facts.scene_file},
                     {"outcome", ""},
                     {"frames", facts.frames},
                     {"frames_written", 0},
                     {"frame_rate", facts.frame_rate},
                     {"step", step},
                     {"steps_per_frame", facts.steps_per_frame},
                     {"steps", 0},
                     {"substeps", 0},
                     {"smallest_step", 0.0},
                     {"seed", facts.seed ? Json(*facts.seed) : Json()},
                     {"threads", facts.threads},
                     {"wall_seconds", 0.0},
                     {"stretch_solver", facts.stretch_solver},
                     {"newton_from", Json::array()},
                     {"limit_solves", 0},
                     {"torn_faces", Json::array()},
                     {"broken_attachments", Json::array()},
                     {"step_adjustments", Json::array()},
                     {"warnings", Json::array()},
                     {"record", Json()},
                     {"formats", facts.formats},
                     {"files", files},
                     {"exports", Json::array()},
                     {"scene", facts.scene.empty() ? Json() : Json::parse(facts.scene)}};
  for (const std::string& format : facts.later_formats) document_->json["formats"].push_back(format);
  document_->warnings = facts.warnings;
  for (const StepAdjustment& adjustment : facts.adjustments) document_->json["step_adjustments"].push_back(json_of(adjustment));
}

RunSummary::~RunSummary() = default;
RunSummary::RunSummary(RunSummary&&) noexcept = default;

void RunSummary::set_record(const std::string& fingerprint) { document_->json["record"] = fingerprint; }

void RunSummary::set_exports(const std::vector<std::string>& patterns) { add_exports(patterns, document_->json); }

std::string RunSummary::text(const RunProgress& progress) const {
  Json& json = document_->json;
  json["outcome"] = progress.outcome;
  json["frames_written"] = progress.frames_written;
  json["steps"] = progress.steps;
  json["substeps"] = progress.substeps;
  json["smallest_step"] = progress.smallest_step;
  json["newton_from"] = Json::array();
  for (const NewtonFrom& from : progress.newton_from) {
    const std::int64_t frame = kFirstComputedFrame + from.step / json["steps_per_frame"].get<int>();
    json["newton_from"].push_back({{"body", from.body}, {"step", from.step}, {"frame", frame}});
  }
  json["limit_solves"] = progress.limit_solves;
  json["torn_faces"] = Json::array();
  for (const TornFaces& torn : progress.torn_faces) {
    json["torn_faces"].push_back({{"body", torn.body}, {"frame", torn.frame}, {"faces", torn.faces}});
  }
  json["broken_attachments"] = Json::array();
  for (const BrokenAttachment& broken : progress.broken_attachments) {
    json["broken_attachments"].push_back({{"name", broken.name},
                                          {"body", broken.body},
                                          {"particle", broken.particle},
                                          {"step", broken.step},
                                          {"frame", frame_of_step(broken.step, json["steps_per_frame"].get<std::int64_t>())}});
  }
  json["warnings"] = document_->warnings;
  for (const std::string& warning : progress.warnings) json["warnings"].push_back(warning);
  json["wall_seconds"] = progress.wall_seconds;
  // A warning may quote a file name that is not UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<WrittenRun> written_run(const std::filesystem::path& run_summary) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(run_summary, ignored)) return std::nullopt;
  std::ifstream stream(run_summary);
  const Json json = Json::parse(stream, nullptr, false);
  if (!is_run_summary(json)) return std::nullopt;
  const Json outcome = json.value("outcome", Json());
  const Json frames = json.value("frames_written", Json());
  const Json scene = json.value("scene", Json());
  return WrittenRun{.outcome = outcome.is_string() ? outcome.get<std::string>() : std::string(),
                    .frames_written = frames.is_number_integer() ? frames.get<int>() : 0,
                    .scene = scene.is_object() ? scene.dump() : std::string(),
                    .files = json["files"].get<std::vector<std::string>>(),
                    .formats = strings_of(json, "formats").value_or(std::vector<std::string>{"obj"})};
}

void add_files_to_run(const std::filesystem::path& folder, const std::vector<std::string>& patterns) {
  const std::filesystem::path file = folder / kRunSummaryFile;
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  if (!is_run_summary(json)) throw FileError("read", file.string(), "it is not the summary of a run");
  if (add_exports(patterns, json)) write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<std::string> exports_of_run(const std::filesystem::path& run_summary) {
  std::ifstream stream(run_summary);
  const Json json = Json::parse(stream, nullptr, false);
  std::vector<std::string> patterns{kAnimationFile};
  if (!is_run_summary(json) || !json.contains("exports") || !json["exports"].is_array()) return patterns;
  for (const Json& pattern : json["exports"]) {
    if (pattern.is_string()) patterns.push_back(pattern.get<std::string>());
  }
  return patterns;
}

std::optional<std::vector<std::string>> files_of_run(const std::filesystem::path& run_summary) {
  auto run = written_run(run_summary);
  return run ? std::optional(std::move(run->files)) : std::nullopt;
}

}  // namespace sprung
