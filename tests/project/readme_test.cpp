#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace sprung::project {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream stream(std::filesystem::path(SPRUNG_SOURCE_DIR) / path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Readme, ShowsTheHelloProgramThatTheInstallTestRuns) {
  const std::string program = text_of("examples/hello.cpp");
  ASSERT_FALSE(program.empty());
  EXPECT_THAT(text_of("README.md"), ::testing::HasSubstr("```cpp\n" + program + "```"));
}

}  // namespace
}  // namespace sprung::project
