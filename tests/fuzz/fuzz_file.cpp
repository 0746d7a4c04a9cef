#include "fuzz/fuzz_file.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace sprung::fuzz {
namespace {

class OwnFolder {
 public:
  // Shared memory spares the disk some thousand files a second.
  OwnFolder() {
    const std::filesystem::path memory = "/dev/shm";
    const std::filesystem::path parent = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = parent / ("sprung_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path_);
  }
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::filesystem::path own_file(const std::string& name) {
  static const OwnFolder kFolder;
  return kFolder.path() / name;
}

void write_bytes(const std::filesystem::path& file, const void* bytes, std::size_t size) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  require(stream != nullptr, "the file of the fuzz program can be written");
  const bool written = std::fwrite(bytes, 1, size, stream) == size;
  require(std::fclose(stream) == 0 && written, "the file of the fuzz program can be written");
}

void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken law: %s\n", law);
  std::abort();
}

}  // namespace sprung::fuzz
