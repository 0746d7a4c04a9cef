#include "viewer/live/saving.h"

#include "base/error.h"
#include "base/files/file_writer.h"
#include "viewer/live/live_run.h"
#include "viewer/page.h"
#include "viewer/replay/html_export.h"
#include "viewer/server/request_check.h"

#include <string_view>
#include <system_error>

namespace sprung {
namespace {

namespace fs = std::filesystem;

bool is_name(const std::string& text) {
  constexpr std::size_t kMostLetters = 64;
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !text.empty() && text.size() <= kMostLetters && text.front() != '-' &&
         text.find_first_not_of(kLetters) == std::string::npos;
}

/// A folder that goes with its owner.
struct ScratchFolder {
  fs::path path = fs::temp_directory_path() / ("sprung-" + random_token());
  ScratchFolder() = default;
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

fs::path new_path(const fs::path& folder, const std::string& name, const std::string& ending) {
  if (!is_name(name)) {
    throw InputError(
        {"", "name", "\"" + name + "\"", "must be 1 to 64 letters, digits, _ and -, the first no -", "give another name"});
  }
  fs::path path = folder / (name + ending);
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(path, ignored))) {
    throw InputError({"", "name", "\"" + name + "\"", "is taken: there is a " + path.string(), "give another name"});
  }
  return path;
}

void save_page(const LiveRun& run, const fs::path& file) {
  const ScratchFolder folder;
  run.save(folder.path);
  write_file(file, html_animation(Replay(folder.path), viewer_page()).text);
}

}  // namespace sprung
