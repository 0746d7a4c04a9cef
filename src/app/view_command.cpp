#include "app/browser.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "base/error.h"
#include "base/files/file_writer.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/file_pattern.h"
#include "output/run_summary.h"
#include "scene/json/near_file.h"
#include "scene/json/nearest_name.h"
#include "viewer/html_export.h"
#include "viewer/live_session.h"
#include "viewer/page.h"
#include "viewer/replay_session.h"
#include "viewer/request_check.h"
#include "viewer/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

namespace {

/// The scenes beside a scene, which the page offers.
std::vector<ExampleScene> scenes_beside(const std::filesystem::path& scene) {
  std::vector<ExampleScene> scenes;
  const std::filesystem::path folder = scene.has_parent_path() ? scene.parent_path() : ".";
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".json" && entry.is_regular_file(ignored)) {
      scenes.push_back({.name = entry.path().stem().string(), .file = entry.path().string()});
    }
  }
  std::ranges::sort(scenes, {}, &ExampleScene::name);
  return scenes;
}

// The page shows problems of a scene; who opens the scene reads the terminal first.
void print_problems(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) print_error(to_string(problem));
}

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

void check_exists(const std::string& target) {
  std::error_code ignored;
  if (std::filesystem::exists(target, ignored)) return;
  const auto run = near_run(target);
  const auto near = run ? run : near_file({""}, target, ".json");
  const std::string remedy =
      near ? fmt::format("did you mean \"{}\"?", *near) : "give a scene file, or the folder of a run as sprung run --out writes it";
  throw FileError("read", target, "there is no such file or folder; " + remedy);
}

/// An export may replace an earlier export in the folder of a run, and no other file of the run.
void check_replaces_no_file_of_run(const std::filesystem::path& file, const std::filesystem::path& run) {
  std::error_code ignored;
  const std::filesystem::path inside =
      std::filesystem::weakly_canonical(file, ignored).lexically_relative(std::filesystem::weakly_canonical(run, ignored));
  if (inside.empty() || inside.begin()->string() == ".." || inside == kAnimationFile) return;
  for (const std::string& pattern : files_of_run(run / kRunSummaryFile).value_or(std::vector<std::string>())) {
    const std::vector<std::filesystem::path> taken = matching_files(run, pattern);
    if (std::ranges::any_of(taken, [&](const auto& name) { return std::filesystem::equivalent(name, file, ignored); })) {
      throw FileError("write", file.string(), "it is a file of the run; give another file by --out");
    }
  }
}

void warn_of_missing(const RecordedRun& run) {
  if (!run.missing().empty()) print_warning(run.missing());
}

std::unique_ptr<ViewSession> session_of(const SceneSource& scene) {
  std::error_code ignored;
  check_exists(scene.file);
  if (std::filesystem::is_directory(scene.file, ignored)) {
    auto replay = std::make_unique<ReplaySession>(scene.file);
    warn_of_missing(replay->run());
    return replay;
  }
  return std::make_unique<LiveSession>(scene, scenes_beside(scene.file), print_problems);
}

}  // namespace

ExitCode view(const ViewOptions& options) {
  const ThreadLimit limit(thread_count(options.threads));
  const std::unique_ptr<ViewSession> session = session_of(options.scene);
  ViewServer server({.port = static_cast<std::uint16_t>(options.port),
                     .token = options.token.empty() ? random_token() : options.token,
                     .page = viewer_page()},
                    *session);
  print_result(server.address() + "\n");
  std::optional<Browser> browser;
  if (options.open) browser.emplace(server.address());
  server.serve([&browser] {
    if (browser) browser->check();
    return interrupted();
  });
  return ExitCode::done;
}

ExitCode export_run(const ExportOptions& options) {
  const std::filesystem::path file =
      options.out.empty() ? std::filesystem::path(options.folder) / kAnimationFile : std::filesystem::path(options.out);
  if (!options.overwrite && std::filesystem::exists(file)) {
    throw FileError("write", file.string(), "it exists; replace it with --overwrite, or give another file by --out");
  }
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file)) {
    throw FileError("write", file.string(), "it is a folder, a pipe or a device; give the name of a file by --out");
  }
  check_exists(options.folder);
  check_replaces_no_file_of_run(file, options.folder);
  const Replay replay(options.folder);
  warn_of_missing(replay.run());
  const HtmlAnimation animation = html_animation(replay, viewer_page());
  write_file(file, animation.text);
  print_message(fmt::format("{}: positions within {} m of the run's", file.string(), format_number(animation.error, 2)));
  return ExitCode::done;
}

}  // namespace sprung
