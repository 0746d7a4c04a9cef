#include "base/files/file_writer.h"

#include "base/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace sprung {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& action, const fs::path& file, int error) {
  throw FileError(action, file.string(), std::generic_category().message(error));
}

/// An open file, closed by the destructor. Errors name `shown`, the final name of the file.
class OpenFile {
 public:
  OpenFile(const fs::path& file, int flags, const fs::path& shown)
      : shown_(shown), descriptor_(::open(file.c_str(), flags | O_CREAT | O_WRONLY | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail("write", shown_, errno);
  }
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("write", shown_, errno);
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  /// Waits until all of its file system is on the disk.
  void sync() {
    if (::syncfs(descriptor_) != 0) fail("write", shown_, errno);
  }

  // Some file systems report a full disk only on close.
  void close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    if (result != 0 && errno != EINTR) fail("write", shown_, errno);
  }

  [[nodiscard]] off_t size() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail("read the size of", shown_, errno);
    return status.st_size;
  }

  void shorten(off_t size) noexcept { [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, size); }

 private:
  const fs::path& shown_;
  int descriptor_;
};

/// Waits until the names of files in a folder are on the disk. Some file systems cannot tell.
void sync_names(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  [[maybe_unused]] const int ignored = ::fsync(descriptor);
  ::close(descriptor);
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
}

}  // namespace

fs::path temporary_path(const fs::path& file) {
  fs::path name = ".";
  name += file.filename();
  name += ".tmp";
  return file.parent_path() / name;
}

void write_file(const fs::path& file, std::string_view text, Durability durability) {
  const fs::path folder = file.parent_path();
  const fs::path temporary = temporary_path(file);
  const bool new_folder = !folder.empty() && !fs::exists(folder);
  if (new_folder) make_folder(folder);
  try {
    OpenFile open(temporary, O_TRUNC, file);
    open.write(text);
    if (durability == Durability::now) open.sync();
    open.close();
    if (::rename(temporary.c_str(), file.c_str()) != 0) fail("write", file, errno);
  } catch (...) {
    remove_quietly(temporary);
    if (new_folder) remove_quietly(folder);
    throw;
  }
  if (durability == Durability::now) sync_names(folder);
}

std::uintmax_t append_to_file(const fs::path& file, std::string_view text) {
  OpenFile open(file, O_APPEND, file);
  const off_t before = open.size();
  try {
    open.write(text);
  } catch (...) {
    open.shorten(before);
    throw;
  }
  open.close();
  return static_cast<std::uintmax_t>(before);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder, error) && !error) error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw FileError("create the folder", folder.string(), error.message());
}

}  // namespace sprung
