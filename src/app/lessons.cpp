#include "app/lessons.h"

#include "app/command_line.h"
#include "base/error.h"
#include "scene/json/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

namespace sprung {
namespace {

namespace fs = std::filesystem;

/// The folder of the lessons, which lies at a fixed path from the program.
fs::path lessons_folder() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const char* path : {SPRUNG_LESSONS, "../../../examples/lessons"}) {
    fs::path folder = (program / path).lexically_normal();
    if (fs::is_directory(folder, ignored)) return folder;
  }
  throw FileError("read", (program / SPRUNG_LESSONS).lexically_normal().string(),
                  "there are no lessons; install Sprung again, or give the scene file of a lesson");
}

bool is_called(const std::string& lesson, const std::string& name) {
  const std::size_t end = std::min(lesson.find('_'), lesson.size());
  return lesson == name || lesson.substr(0, end) == name || (end < lesson.size() && lesson.substr(end + 1) == name);
}

}  // namespace

std::string lesson_file(const std::string& name) {
  const fs::path folder = lessons_folder();
  std::vector<std::string> lessons;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") lessons.push_back(entry.path().stem().string());
  }
  std::ranges::sort(lessons);
  for (const std::string& lesson : lessons) {
    if (is_called(lesson, name)) return (folder / (lesson + ".json")).string();
  }
  throw UsageError(fmt::format("--lesson {}: there is no such lesson; choose from {}", name, joined(lessons)));
}

}  // namespace sprung
