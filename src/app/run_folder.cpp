#include "app/run_folder.h"

#include "app/console.h"
#include "base/error.h"
#include "base/files/file_pattern.h"
#include "output/recorded_run.h"
#include "output/run_summary.h"
#include "scene/json/near_file.h"
#include "scene/json/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace sprung {
namespace {

/// The run's folder that was probably meant by a name that does not exist.
std::optional<std::string> near_run(const std::filesystem::path& missing) {
  const std::filesystem::path named = missing.has_filename() ? missing : missing.parent_path();  // of "frames/"
  std::vector<std::string> runs;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(named.has_parent_path() ? named.parent_path() : ".", ignored)) {
    if (std::filesystem::exists(entry.path() / kRunSummaryFile, ignored)) runs.push_back(entry.path().filename().string());
  }
  std::ranges::sort(runs);
  const auto name = nearest_name(named.filename().string(), runs);
  if (!name) return std::nullopt;
  return (named.parent_path() / *name).string();
}

}  // namespace

void check_exists(const std::string& target) {
  std::error_code ignored;
  if (std::filesystem::exists(target, ignored)) return;
  const auto run = near_run(target);
  const auto near = run ? run : near_file({""}, target, ".json");
  const std::string remedy =
      near ? fmt::format("did you mean \"{}\"?", *near) : "give a scene file, or the folder of a run as sprung run --out writes it";
  throw FileError("read", target, "there is no such file or folder; " + remedy);
}

void check_replaces_no_file_of_run(const std::filesystem::path& file, const std::filesystem::path& run) {
  std::error_code ignored;
  const std::filesystem::path inside =
      std::filesystem::weakly_canonical(file, ignored).lexically_relative(std::filesystem::weakly_canonical(run, ignored));
  if (inside.empty() || inside.begin()->string() == "..") return;
  const std::vector<std::string> exports = exports_of_run(run / kRunSummaryFile);
  for (const std::string& pattern : files_of_run(run / kRunSummaryFile).value_or(std::vector<std::string>())) {
    if (std::ranges::find(exports, pattern) != exports.end()) continue;
    const std::vector<std::filesystem::path> taken = matching_files(run, pattern);
    if (std::ranges::any_of(taken, [&](const auto& name) { return std::filesystem::equivalent(name, file, ignored); })) {
      throw FileError("write", file.string(), "it is a file of the run; give another file by --out");
    }
  }
}

void warn_of_missing(const RecordedRun& run) {
  if (!run.missing().empty()) print_warning(run.missing());
}

}  // namespace sprung
