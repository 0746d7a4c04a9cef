#include "app/browser.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/lessons.h"
#include "app/run_folder.h"
#include "base/error.h"
#include "base/files/file_writer.h"
#include "base/format.h"
#include "base/parallel.h"
#include "viewer/live/live_session.h"
#include "viewer/page.h"
#include "viewer/protocol/example_scenes.h"
#include "viewer/replay/html_export.h"
#include "viewer/replay/replay_session.h"
#include "viewer/server/request_check.h"
#include "viewer/server/server.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

namespace {

// The page shows problems of a scene; who opens the scene reads the terminal first.
void print_problems(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) print_error(to_string(problem));
}

std::unique_ptr<ViewSession> session_of(const ViewOptions& options) {
  std::error_code ignored;
  SceneSource scene = options.scene;
  if (!options.lesson.empty()) scene.file = lesson_file(options.lesson);
  check_exists(scene.file);
  if (std::filesystem::is_directory(scene.file, ignored)) {
    auto replay = std::make_unique<ReplaySession>(scene.file);
    warn_of_missing(replay->run());
    return replay;
  }
  return std::make_unique<LiveSession>(scene, scenes_beside(scene.file), print_problems, options.save_to);
}

}  // namespace

ExitCode view(const ViewOptions& options) {
  const ThreadLimit limit(thread_count(options.threads));
  const std::unique_ptr<ViewSession> session = session_of(options);
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

void export_html(const std::string& folder, const std::filesystem::path& file) {
  const Replay replay(folder);
  warn_of_missing(replay.run());
  const HtmlAnimation animation = html_animation(replay, viewer_page());
  write_file(file, animation.text);
  print_message(fmt::format("{}: positions within {} m of the run's", file.string(), format_number(animation.error, 2)));
}

}  // namespace sprung
