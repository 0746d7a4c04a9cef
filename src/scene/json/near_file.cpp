#include "scene/json/near_file.h"

#include "scene/json/nearest_name.h"

#include <algorithm>
#include <system_error>

namespace sprung {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostEntries = 10'000;  // of a folder; a message is not worth reading more

/// Files and folders of a folder, by name.
std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  fs::directory_iterator entry(folder.empty() ? "." : folder, error);
  for (; !error && entry != fs::directory_iterator() && entries.size() < kMostEntries; entry.increment(error)) {
    entries.push_back(*entry);
  }
  std::ranges::sort(entries, {}, [](const fs::directory_entry& e) { return e.path(); });  // folders have no order
  return entries;
}

class Files {
 public:
  explicit Files(const std::string& extension) : extension_(extension) {}

  /// Adds the files of `root / folder`, as paths from `root`.
  void add(const fs::path& root, const fs::path& folder) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : entries_of(root / folder)) {
      const fs::path name = entry.path().filename();
      if (entry.is_regular_file(ignored) && (extension_.empty() || name.extension() == extension_)) paths_.push_back(folder / name);
    }
  }

  void add_with_folders_below(const fs::path& root) {
    add(root, "");
    std::error_code ignored;
    for (const fs::directory_entry& entry : entries_of(root)) {
      if (entry.is_directory(ignored) && entry.path().filename().string().front() != '.') add(root, entry.path().filename());
    }
  }

  /// The path whose file name is nearest; of several with this name, the one whose path is.
  [[nodiscard]] std::optional<std::string> nearest(const fs::path& missing) const {
    std::vector<std::string> names;
    for (const fs::path& path : paths_) names.push_back(path.filename().string());
    const auto name = nearest_name(missing.filename().string(), names);
    if (!name) return std::nullopt;
    std::vector<std::string> paths;
    for (const fs::path& path : paths_) {
      if (path.filename() == *name) paths.push_back(path.string());
    }
    return nearest_name(missing.string(), paths).value_or(paths.front());
  }

 private:
  std::string extension_;
  std::vector<fs::path> paths_;
};

}  // namespace

std::optional<std::string> near_file(const std::vector<fs::path>& folders, const fs::path& missing, const std::string& extension) {
  Files beside(extension);
  for (const fs::path& folder : folders) beside.add(folder, missing.parent_path());
  if (auto file = beside.nearest(missing)) return file;
  Files elsewhere(extension);
  for (const fs::path& folder : folders) elsewhere.add_with_folders_below(folder);
  return elsewhere.nearest(missing);
}

}  // namespace sprung
