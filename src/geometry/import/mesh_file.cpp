#include "geometry/import/mesh_file.h"

#include "base/files/text_encoding.h"
#include "base/format.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

namespace sprung {
namespace {

constexpr std::size_t kProblemsKept = 20;

[[noreturn]] void refuse(const std::filesystem::path& file, std::string rule, std::string remedy) {
  throw InputError(Problem{.file = file.string(), .rule = std::move(rule), .remedy = std::move(remedy)});
}

}  // namespace

void FileProblems::add(std::string location, std::string value, std::string rule, std::string remedy) {
  if (problems_.size() < kProblemsKept) {
    problems_.push_back({file_, std::move(location), std::move(value), std::move(rule), std::move(remedy)});
  } else {
    ++left_out_;
  }
}

void FileProblems::throw_if_any() const {
  if (problems_.empty()) return;
  std::vector<Problem> all = problems_;
  if (left_out_ > 0) all.push_back({.file = file_, .rule = "has " + std::to_string(left_out_) + " more problems like these"});
  throw InputError(std::move(all));
}

std::string lower_case_extension(const std::filesystem::path& file) { return lower_case(file.extension().string()); }

std::string read_mesh_file(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (status.type() == std::filesystem::file_type::not_found) refuse(file, "does not exist", "check the path");
  if (status.type() == std::filesystem::file_type::directory) refuse(file, "is a folder", "name a mesh file in it");
  if (status.type() != std::filesystem::file_type::regular && status.type() != std::filesystem::file_type::none) {
    refuse(file, "is not a regular file", "a pipe or a device may never end; copy it to a file");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  if (stream.peek() != std::ifstream::traits_type::eof()) bytes << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) {
    refuse(file, std::string("cannot be read: ") + std::strerror(errno), "check that you may read it");
  }
  std::string text = std::move(bytes).str();
  if (text.empty()) refuse(file, "is empty", "export it again");
  return text;
}

std::string read_mesh_text(const std::filesystem::path& file) { return utf8_text(read_mesh_file(file)); }

}  // namespace sprung
