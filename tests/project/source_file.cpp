#include "project/source_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace sprung::project {

SourceFile parse_source(const std::string& path, const std::string& text) {
  static const std::regex kIncludeLine(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  SourceFile file{.path = path, .folder = path.substr(0, path.find('/')), .includes = {}};
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kIncludeLine)) file.includes.push_back({match[2], match[1] == "\""});
  }
  return file;
}

std::vector<SourceFile> read_sources(const std::filesystem::path& root) {
  std::vector<SourceFile> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    files.push_back(parse_source(entry.path().lexically_relative(root).generic_string(), text));
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace sprung::project
