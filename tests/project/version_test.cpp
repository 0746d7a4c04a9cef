// The version stands in CMakeLists.txt; what cannot read it there must agree with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace sprung::project {
namespace {

/// The first part of a file that `pattern` encloses in parentheses; empty if nothing matches.
std::string found_in(const std::string& path, const std::string& pattern) {
  std::ifstream stream(std::filesystem::path(SPRUNG_SOURCE_DIR) / path);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

class Version : public ::testing::Test {
 protected:
  const std::string version_ = found_in("CMakeLists.txt", R"(project\(sprung VERSION (\d+\.\d+\.\d+))");
};

TEST_F(Version, IsThatOfTheChangelogsNewestEntry) {
  ASSERT_NE(version_, "");
  EXPECT_EQ(found_in("CHANGELOG.md", R"(\n## (\d+\.\d+\.\d+) - \d{4}-\d\d-\d\d\n)"), version_);
}

TEST_F(Version, IsThatOfTheBlenderAddOn) {
  EXPECT_EQ(found_in("src/blender/sprung/blender_manifest.toml", R"re(\nversion = "([^"]+)")re"), version_);
  const std::string commas = std::regex_replace(version_, std::regex(R"(\.)"), ", ");
  EXPECT_EQ(found_in("src/blender/sprung/__init__.py", R"re("version": \(([^)]+)\))re"), commas);
}

TEST_F(Version, IsThatOfTheProtocolsExample) {
  EXPECT_EQ(found_in("src/viewer/PROTOCOL.md", R"re("type": "hello", "version": "([^"]+)")re"), version_);
}

TEST_F(Version, IsThatOfTheConsumersExample) {
  EXPECT_EQ(found_in("tests/project/consumer/CMakeLists.txt", R"(find_package\(sprung (\d+\.\d+) )"),
            version_.substr(0, version_.rfind('.')));
}

}  // namespace
}  // namespace sprung::project
