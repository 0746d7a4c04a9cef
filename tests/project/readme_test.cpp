#include "project/source_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace sprung::project {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream stream(std::filesystem::path(SPRUNG_SOURCE_DIR) / path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The lines of the list from which installation takes headers.
std::set<std::string> public_headers() {
  std::istringstream lines(text_of("src/public_headers.txt"));
  std::set<std::string> headers;
  for (std::string line; std::getline(lines, line);) headers.insert(line);
  return headers;
}

/// The headers that README names for programs.
std::set<std::string> headers_of_readme() {
  const std::string readme = text_of("README.md");
  const std::size_t begin = readme.find("### The headers of the library");
  const std::string section = readme.substr(begin, readme.find("\n## ", begin) - begin);
  static const std::regex kHeader(R"re(\[`([^`]+\.h)`\]\(src/([^)]+)\))re");
  std::set<std::string> headers;
  for (std::sregex_iterator match(section.begin(), section.end(), kHeader), end; match != end; ++match) {
    EXPECT_EQ((*match)[1], (*match)[2]) << "a link to another file than it names";
    headers.insert((*match)[1]);
  }
  return headers;
}

TEST(Readme, ShowsTheHelloProgramThatTheInstallTestRuns) {
  const std::string program = text_of("examples/hello.cpp");
  ASSERT_FALSE(program.empty());
  EXPECT_THAT(text_of("README.md"), ::testing::HasSubstr("```cpp\n" + program + "```"));
}

TEST(Readme, NamesTheHeadersThatAreInstalled) {
  EXPECT_FALSE(public_headers().empty());
  EXPECT_EQ(headers_of_readme(), public_headers());
}

TEST(Readme, NamesTheHeadersThatExamplesInclude) {
  const std::set<std::string> headers = headers_of_readme();
  const std::vector<SourceFile> examples = read_sources(std::filesystem::path(SPRUNG_SOURCE_DIR) / "examples");
  EXPECT_FALSE(examples.empty());
  for (const SourceFile& example : examples) {
    for (const Include& include : example.includes) {
      const bool is_named = !include.quoted || headers.contains(include.path);
      EXPECT_TRUE(is_named) << example.path << " includes \"" << include.path << "\"";
    }
  }
}

}  // namespace
}  // namespace sprung::project
