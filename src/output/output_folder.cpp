#include "output/output_folder.h"

#include "base/error.h"
#include "base/files/file_pattern.h"
#include "base/files/file_writer.h"
#include "output/run_summary.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

namespace fs = std::filesystem;

// The only file of a run that was killed during its first write. Its name identifies it.
void remove_unfinished_summary(const fs::path& folder) { fs::remove(temporary_path(folder / kRunSummaryFile)); }

/// Folders in the place of a run's files are the user's.
void expect_no_folders(const fs::path& folder, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    if (stays_inside(pattern) && fs::is_directory(fs::symlink_status(folder / pattern))) {
      throw FileError("overwrite", (folder / pattern).string(), "it is a folder; move it away");
    }
  }
}

void remove_files_of_run(const fs::path& folder, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    if (!stays_inside(pattern)) continue;
    for (const std::string& name : {pattern, temporary_path(pattern).string()}) {
      for (const fs::path& file : matching_files(folder, name)) fs::remove(file);
    }
    std::error_code not_empty;
    for (fs::path directory = fs::path(pattern).parent_path(); !directory.empty(); directory = directory.parent_path()) {
      fs::remove(folder / directory, not_empty);
    }
  }
}

void remove_earlier_run(const fs::path& folder) {
  std::optional<std::vector<std::string>> patterns = files_of_run(folder / kRunSummaryFile);
  if (!patterns) {
    throw FileError("overwrite the folder", folder.string(),
                    "it has files but no run of sprung; choose another folder, or empty this one yourself");
  }
  expect_no_folders(folder, *patterns);
  std::erase(*patterns, kRunSummaryFile);
  remove_files_of_run(folder, *patterns);
  fs::remove(folder / kRunSummaryFile);
}

/// Calls `use()`. Throws FileError in place of an error of the file system.
template <class Use>
auto with_folder(const fs::path& folder, const Use& use) {
  try {
    return use();
  } catch (const fs::filesystem_error& error) {
    throw FileError("use the folder", folder.string(), error.path1().string() + ": " + error.code().message());
  }
}

fs::path made(fs::path folder) {
  make_folder(folder);
  return folder;
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder) : folder_(made(std::move(folder))), lock_(folder_) {
  with_folder(folder_, [&] { remove_unfinished_summary(folder_); });
}

OutputFolder::OutputFolder(fs::path folder, bool overwrite) : OutputFolder(std::move(folder)) {
  if (is_empty()) return;
  if (!overwrite) {
    throw FileError("write into the folder", folder_.string(),
                    "it is not empty; choose another folder, go on with its run by --resume, or replace it with --overwrite");
  }
  remove_run();
}

OutputFolder OutputFolder::as_it_is(fs::path folder) { return OutputFolder(std::move(folder)); }

void OutputFolder::remove_run() const {
  with_folder(folder_, [&] { remove_earlier_run(folder_); });
}

bool OutputFolder::is_empty() const {
  return with_folder(folder_, [&] {
    const fs::directory_iterator files(folder_);
    return std::all_of(begin(files), end(files),
                       [](const fs::directory_entry& entry) { return entry.path().filename() == kLockFile; });
  });
}

void OutputFolder::expect_free(const std::vector<std::string>& patterns) const {
  for (const std::string& pattern : patterns) {
    const std::vector<fs::path> files = matching_files(folder_, pattern);
    if (!files.empty()) throw FileError("write", files.front().string(), "it exists and is not from an earlier run; move it away");
  }
}

void OutputFolder::write(const fs::path& file, const std::string& text) const { write_file(folder_ / file, text); }

std::uintmax_t OutputFolder::append(const fs::path& file, const std::string& text) const {
  return append_to_file(folder_ / file, text);
}

void OutputFolder::shorten(const fs::path& file, std::uintmax_t size) const noexcept {
  std::error_code ignored;
  fs::resize_file(folder_ / file, size, ignored);
}

void OutputFolder::cut(const fs::path& file, std::uintmax_t size) const {
  if (this->size(file) <= size) return;
  std::error_code error;
  fs::resize_file(folder_ / file, size, error);
  if (error) throw FileError("shorten", (folder_ / file).string(), error.message());
}

std::uintmax_t OutputFolder::size(const fs::path& file) const noexcept {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(folder_ / file, error);
  return error ? 0 : size;
}

void OutputFolder::remove(const fs::path& file) const noexcept {
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(folder_ / file, ignored))) fs::remove(folder_ / file, ignored);
}

}  // namespace sprung
