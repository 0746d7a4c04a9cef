#include "base/files/file_pattern.h"

#include <algorithm>

namespace sprung {
namespace {

namespace fs = std::filesystem;

constexpr int kMinDigits = 4;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool matches(const std::string& pattern, const std::string& name) {
  return std::equal(pattern.begin(), pattern.end(), name.begin(), name.end(),
                    [](char expected, char found) { return expected == '#' ? is_digit(found) : expected == found; });
}

}  // namespace

std::string sequence_pattern(const std::string& name, int frames, const std::string& ending) {
  const int digits = std::max(kMinDigits, static_cast<int>(std::to_string(frames).size()));
  return name + "." + std::string(static_cast<std::size_t>(digits), '#') + ending;
}

std::string fill_pattern(const std::string& pattern, int frame) {
  const std::size_t begin = pattern.find('#');
  const std::size_t end = pattern.find_last_of('#') + 1;
  if (begin == std::string::npos) return pattern;
  const std::string number = std::to_string(frame);
  const std::size_t width = std::max(end - begin, number.size());
  return pattern.substr(0, begin) + std::string(width - number.size(), '0') + number + pattern.substr(end);
}

bool is_folder_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

bool stays_inside(const std::string& pattern) {
  const fs::path path(pattern);
  return !path.empty() && path.is_relative() && path.has_filename() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& component) { return component == ".." || component == "."; });
}

std::vector<fs::path> matching_files(const fs::path& folder, const std::string& pattern) {
  fs::path directory = folder;
  for (const fs::path& component : fs::path(pattern).parent_path()) {
    directory /= component;
    if (!fs::is_directory(fs::symlink_status(directory))) return {};
  }
  const std::string name = fs::path(pattern).filename().string();
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    if (!entry.is_directory() && matches(name, entry.path().filename().string())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace sprung
