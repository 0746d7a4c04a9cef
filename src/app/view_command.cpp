#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "base/error.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/file_writer.h"
#include "output/run_summary.h"
#include "viewer/html_export.h"
#include "viewer/live_session.h"
#include "viewer/page.h"
#include "viewer/replay_session.h"
#include "viewer/request_check.h"
#include "viewer/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

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

std::unique_ptr<ViewSession> session_of(const SceneSource& scene) {
  std::error_code ignored;
  if (std::filesystem::is_directory(scene.file, ignored)) {
    auto replay = std::make_unique<ReplaySession>(scene.file);
    if (!replay->run().missing().empty()) print_warning(replay->run().missing());
    return replay;
  }
  return std::make_unique<LiveSession>(scene, scenes_beside(scene.file), print_problems);
}

void open_in_browser(const std::string& address) {
  if (std::system(("xdg-open '" + address + "' > /dev/null 2>&1 &").c_str()) != 0) {
    print_message("no browser could be opened; open the address yourself");
  }
}

}  // namespace

ExitCode view(const ViewOptions& options) {
  const ThreadLimit limit(options.threads.value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency()))));
  const std::unique_ptr<ViewSession> session = session_of(options.scene);
  ViewServer server({.port = static_cast<std::uint16_t>(options.port),
                     .token = options.token.empty() ? random_token() : options.token,
                     .page = viewer_page()},
                    *session);
  print_result(server.address() + "\n");
  if (options.open) open_in_browser(server.address());
  server.serve(interrupted);
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
  const Replay replay(options.folder);
  if (!replay.run().missing().empty()) print_warning(replay.run().missing());
  const HtmlAnimation animation = html_animation(replay, viewer_page());
  write_file(file, animation.text);
  print_message(fmt::format("{}: positions within {} m of the run's", file.string(), format_number(animation.error, 2)));
  return ExitCode::done;
}

}  // namespace sprung
