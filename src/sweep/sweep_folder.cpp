#include "sweep/sweep_folder.h"

#include "base/error.h"
#include "base/files/file_writer.h"
#include "base/format.h"
#include "output/folder_lock.h"
#include "output/run_summary.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const std::string kProgram = "sprung sweep";
constexpr const char* kJournals = "journal";
constexpr const char* kRunsBegin = "  \"runs\": [";  // a line of manifest.json

constexpr std::array<const char*, 4> kStatusNames{"pending", "running", "done", "failed"};

const char* name_of(RunStatus status) { return kStatusNames.at(static_cast<std::size_t>(status)); }

/// As the scene reads it: JSON, or else a word.
Json value_of(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_discarded() ? Json(text) : value;
}

std::string dumped(const Json& json, int indent = -1) { return json.dump(indent, ' ', false, Json::error_handler_t::replace); }

/// What must be the same when a sweep goes on, by its name for the user.
Json identity_of(const SweepSettings& settings) {
  return {{"scene_file", settings.scene.file},
          {"set", settings.scene.overrides},
          {"mesh_paths", settings.scene.mesh_paths},
          {"vary", settings.request.vary},
          {"sample", settings.request.sample},
          {"count", settings.request.count},
          {"seed", settings.request.seed},
          {"formats", settings.formats},
          {"frames", settings.frames ? Json(*settings.frames) : Json()},
          {"engine", settings.engine},
          {"array_size", settings.array_size},
          {"scene", settings.first_scene.empty() ? Json() : Json::parse(settings.first_scene)}};
}

SweepSettings settings_of(const Json& json) {
  SweepSettings settings;
  settings.scene.file = json.at("scene_file").get<std::string>();
  settings.scene.overrides = json.at("set").get<std::vector<std::string>>();
  settings.scene.mesh_paths = json.at("mesh_paths").get<std::vector<std::string>>();
  settings.request.vary = json.at("vary").get<std::vector<std::string>>();
  settings.request.sample = json.at("sample").get<std::vector<std::string>>();
  settings.request.count = json.at("count").get<int>();
  settings.request.seed = json.at("seed").get<std::uint64_t>();
  settings.formats = json.at("formats").get<std::vector<std::string>>();
  if (!json.at("frames").is_null()) settings.frames = json.at("frames").get<int>();
  settings.engine = json.at("engine").get<std::string>();
  settings.array_size = json.at("array_size").get<int>();
  settings.first_scene = json.at("scene").is_null() ? "" : json.at("scene").dump();
  return settings;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

/// Compares objects key by key, lists of the same size entry by entry, and other values as a whole.
void add_differences(const Json& before, const Json& now, const std::string& path, Problem base, std::vector<Problem>& problems) {
  if (before == now) return;
  if (before.is_array() && now.is_array() && before.size() == now.size()) {
    for (std::size_t k = 0; k < now.size(); ++k) {
      add_differences(before[k], now[k], path + "[" + std::to_string(k) + "]", base, problems);
    }
    return;
  }
  if (!before.is_object() || !now.is_object()) {
    base.key = path;
    base.value = now.is_null() ? "none" : shortened(dumped(now));
    base.rule = "the sweep in the folder has " + (before.is_null() ? std::string("none") : shortened(dumped(before)));
    problems.push_back(std::move(base));
    return;
  }
  const auto below = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  for (const auto& [key, value] : before.items()) add_differences(value, now.value(key, Json()), below(key), base, problems);
  for (const auto& [key, value] : now.items()) {
    if (!before.contains(key)) add_differences(Json(), value, below(key), base, problems);
  }
}

Json line_of(int run, const RunState& state) {
  return {{"run", run},
          {"status", name_of(state.status)},
          {"exit_code", state.exit_code},
          {"seconds", state.seconds},
          {"message", state.message},
          {"columns", state.columns},
          {"row", state.row}};
}

/// Does nothing for a line that is not whole, or of something else.
void read_line(const std::string& line, std::vector<RunState>& states) try {
  const Json json = Json::parse(line);
  const int run = json.at("run").get<int>();
  if (run < 1 || run > static_cast<int>(states.size())) return;
  const auto* name = std::ranges::find(kStatusNames, json.at("status").get<std::string>());
  if (name == kStatusNames.end()) return;
  states[static_cast<std::size_t>(run - 1)] = {.status = static_cast<RunStatus>(name - kStatusNames.begin()),
                                               .exit_code = json.at("exit_code").get<int>(),
                                               .seconds = json.at("seconds").get<double>(),
                                               .message = json.at("message").get<std::string>(),
                                               .columns = json.at("columns").get<std::string>(),
                                               .row = json.at("row").get<std::string>()};
} catch (const Json::exception&) {
  return;
}

/// The text of a manifest without its runs, of which the journals know more: a million of them take a gigabyte to parse.
std::string manifest_head(std::istream& manifest) {
  std::string text;
  for (std::string line; std::getline(manifest, line);) {
    text.append(line).append("\n");
    if (line == kRunsBegin) return text + "]}";
  }
  return text;
}

/// False if its writer was killed in the middle of a line.
bool ends_with_a_line(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream || stream.tellg() == 0) return true;
  stream.seekg(-1, std::ios::end);
  return stream.get() == '\n';
}

/// A field of a CSV file: RFC 4180.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + '"';
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  if (line.ends_with(',')) fields.emplace_back();
  return fields;
}

/// The largest value of a column.
class Largest {
 public:
  Largest(const std::vector<std::string>& names, const std::string& column)
      : place_(static_cast<std::size_t>(std::ranges::find(names, column) - names.begin())) {}

  void see(const std::vector<std::string>& fields) {
    if (place_ >= fields.size()) return;
    const double value = std::strtod(fields[place_].c_str(), nullptr);
    if (!field_.empty() && value <= value_) return;
    value_ = value;
    field_ = fields[place_];
  }
  /// As it is written; empty if the column is missing.
  [[nodiscard]] const std::string& field() const { return field_; }

 private:
  std::size_t place_;
  double value_ = 0.0;
  std::string field_{};
};

}  // namespace

struct SweepFolder::Manifest {
  SweepSettings settings;
  SweepProgress progress;
};

bool has_sweep(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / kManifestFile, ignored);
}

SweepFolder::Manifest SweepFolder::read_manifest(const fs::path& folder) {
  const fs::path file = folder / kManifestFile;
  const auto refuse = [&](const std::string& rule) -> InputError {
    return InputError(Problem{.file = file.string(), .rule = rule, .remedy = "give the folder of a sweep, as --out names it"});
  };
  std::ifstream stream(file);
  if (!stream) throw refuse("there is no sweep in the folder");
  const Json json = Json::parse(manifest_head(stream), nullptr, false);
  if (!json.is_object() || json.value("program", Json()) != kProgram) throw refuse("it is not the manifest of a sweep");
  try {
    return {settings_of(json),
            {.jobs = json.at("jobs").get<int>(),
             .checkpoint = json.at("checkpoint").get<double>(),
             .job = json.at("job").get<std::string>()}};
  } catch (const Json::exception&) {
    throw refuse("it is the manifest of another version of sprung");
  }
}

SweepFolder::SweepFolder(const fs::path& folder) : SweepFolder(folder, read_manifest(folder)) {}

SweepFolder::SweepFolder(fs::path folder, Manifest manifest) : SweepFolder(std::move(folder), std::move(manifest.settings)) {
  progress_ = std::move(manifest.progress);
  read_journals();
}

SweepFolder::SweepFolder(fs::path folder, SweepSettings settings)
    : path_(std::move(folder)),
      settings_(std::move(settings)),
      plan_(settings_.request),
      states_(static_cast<std::size_t>(plan_.run_count())) {}

void SweepFolder::check_is_same_or_free() const {
  if (has_sweep(path_)) {
    const Problem base{.file = (path_ / kManifestFile).string(),
                       .remedy = "go on with the same values, or choose another folder by --out"};
    Json before = identity_of(read_manifest(path_).settings);
    Json now = identity_of(settings_);
    const Json scene_before = std::exchange(before["scene"], Json());
    const Json scene_now = std::exchange(now["scene"], Json());
    std::vector<Problem> problems;
    add_differences(before, now, "", base, problems);
    // The scenes are those of the first values, so other values explain their differences.
    if (problems.empty()) add_differences(scene_before, scene_now, "scene", base, problems);
    if (!problems.empty()) throw InputError(problems);
    return;
  }
  std::error_code error;
  if (!fs::exists(path_, error)) return;
  const fs::directory_iterator files(path_, error);
  if (error) throw FileError("use the folder", path_.string(), error.message());
  // Those of a sweep that was killed as it began.
  const std::array<std::string, 2> own{kLockFile, temporary_path(kManifestFile).string()};
  const bool is_free = std::all_of(begin(files), end(files), [&](const fs::directory_entry& entry) {
    return std::ranges::find(own, entry.path().filename().string()) != own.end();
  });
  if (!is_free) {
    throw FileError("write into the folder", path_.string(), "it is not empty and has no sweep; choose another folder by --out");
  }
}

void SweepFolder::read_journals() {
  states_.assign(states_.size(), RunState{});
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_ / kJournals, error)) {
    std::ifstream stream(entry.path());
    for (std::string line; std::getline(stream, line);) read_line(line, states_);
  }
}

void SweepFolder::note(int run, RunState state) {
  const int task = task_of(run);
  const fs::path journal = path_ / kJournals / ("task-" + std::to_string(task) + ".jsonl");
  make_folder(path_ / kJournals);
  const bool is_new = journals_.insert(task).second;
  const bool is_broken = is_new && !ends_with_a_line(journal);
  std::string text(is_broken ? "\n" : "");
  text += dumped(line_of(run, state));
  text += '\n';
  append_to_file(journal, text);
  states_[static_cast<std::size_t>(run - 1)] = std::move(state);
}

RunCounts SweepFolder::counts() const {
  RunCounts counts;
  double seconds = 0.0;
  for (const RunState& state : states_) {
    const std::array<int*, kStatusNames.size()> by_status{&counts.pending, &counts.running, &counts.done, &counts.failed};
    ++*by_status.at(static_cast<std::size_t>(state.status));
    seconds += state.seconds;
  }
  const int ended = counts.done + counts.failed;
  if (ended > 0) counts.mean_seconds = seconds / ended;
  return counts;
}

void SweepFolder::write_manifest() const {
  Json head{{"program", kProgram}, {"version", SPRUNG_VERSION}};
  head.update(identity_of(settings_));
  head.update({{"jobs", progress_.jobs}, {"checkpoint", progress_.checkpoint}, {"job", progress_.job}});
  // The runs are written one a line, and without a document of all of them, which would need several times the memory.
  std::string text = dumped(head, 2);
  text.erase(text.find_last_of('\n'));
  text.append(",\n").append(kRunsBegin);
  for (int run = 1; run <= plan_.run_count(); ++run) {
    const RunState& state_of_run = state(run);
    Json values = Json::object();
    const std::vector<std::string> texts = plan_.values_of(run);
    for (std::size_t key = 0; key < texts.size(); ++key) values[plan_.keys()[key]] = value_of(texts[key]);
    const bool ended = state_of_run.status == RunStatus::done || state_of_run.status == RunStatus::failed;
    Json entry{{"number", run},
               {"values", std::move(values)},
               {"status", name_of(state_of_run.status)},
               {"exit_code", ended && state_of_run.exit_code >= 0 ? Json(state_of_run.exit_code) : Json()},
               {"seconds", ended ? Json(state_of_run.seconds) : Json()}};
    if (!state_of_run.message.empty()) entry["message"] = state_of_run.message;
    text += run > 1 ? ",\n    " : "\n    ";
    text += dumped(entry);
  }
  text += "\n  ]\n}\n";
  write_file(path_ / kManifestFile, text);
}

void SweepFolder::write_results() const {
  std::vector<std::string> columns;
  std::map<std::string, std::vector<std::size_t>> places;  // by the text of a head: the column of each field
  for (const RunState& state : states_) {
    const auto [entry, is_new] = places.try_emplace(state.columns);
    if (!is_new) continue;
    for (const std::string& name : fields_of(state.columns)) {
      const auto found = std::ranges::find(columns, name);
      entry->second.push_back(static_cast<std::size_t>(found - columns.begin()));
      if (found == columns.end()) columns.push_back(name);
    }
  }
  std::string text = "number,status,exit_code,seconds";
  for (const std::string& key : plan_.keys()) text += ',' + csv_field(key);
  for (const std::string& column : columns) text += ',' + column;
  text += '\n';
  for (int run = 1; run <= plan_.run_count(); ++run) {
    const RunState& ended = state(run);
    if (ended.status != RunStatus::done && ended.status != RunStatus::failed) continue;
    text += std::to_string(run) + ',' + name_of(ended.status) + ',' + (ended.exit_code < 0 ? "" : std::to_string(ended.exit_code)) +
            ',' + format_number(ended.seconds);
    for (const std::string& value : plan_.values_of(run)) text += ',' + csv_field(value);
    std::vector<std::string> fields(columns.size());
    const std::vector<std::string> own = fields_of(ended.row);
    const std::vector<std::size_t>& place = places.at(ended.columns);
    for (std::size_t field = 0; field < std::min(own.size(), place.size()); ++field) fields[place[field]] = own[field];
    for (const std::string& field : fields) text += ',' + field;
    text += '\n';
  }
  write_file(path_ / kResultsFile, text);
}

RunResult result_of_run(const fs::path& folder) {
  std::ifstream diagnostics(folder / kDiagnosticsFile);
  RunResult result;
  std::getline(diagnostics, result.columns);
  const std::vector<std::string> names = fields_of(result.columns);
  std::array<Largest, 2> extremes{Largest(names, "max_stretch"), Largest(names, "stretch_excess")};
  for (std::string line; std::getline(diagnostics, line);) {
    result.row = line;
    const std::vector<std::string> fields = fields_of(line);
    for (Largest& extreme : extremes) extreme.see(fields);
  }
  if (result.row.empty()) return {};
  std::ifstream stream(folder / kRunSummaryFile);
  const Json summary = Json::parse(stream, nullptr, false);
  const Json seconds = summary.is_object() ? summary.value("wall_seconds", Json()) : Json();
  result.columns += ",largest_stretch,largest_stretch_excess,wall_seconds";
  for (const Largest& extreme : extremes) result.row += ',' + extreme.field();
  result.row += ',' + (seconds.is_number() ? format_number(seconds.get<double>()) : std::string());
  return result;
}

}  // namespace sprung
