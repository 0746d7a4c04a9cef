// A lock on the folder of a run, so that two programs do not write into it.
#pragma once

#include <filesystem>

namespace sprung {

/// The file that is locked. It holds the number of the process, and is gone after a run that ended by itself.
inline constexpr const char* kLockFile = ".sprung.lock";

/// Advisory: only programs that ask for the lock notice it. It ends with the process, however that ends.
class FolderLock {
 public:
  /// Requires that the folder exists. Throws FileError if another process holds the lock, which is named, or if the file cannot be
  /// written. File systems without locks give none.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_;
};

/// Whether a process holds the lock of a folder. False for a folder that does not exist. It takes the lock for a moment to know, so
/// call it only where no process is about to lock the folder.
[[nodiscard]] bool is_locked(const std::filesystem::path& folder);

}  // namespace sprung
