#include "base/files/file_pattern.h"

#include "base/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::ScratchFolder;
using testing::write_text;

TEST(FilePattern, HasFourDigitsUntilTheLastFrameNeedsMore) {
  EXPECT_EQ(sequence_pattern("a/a", 1), "a/a.####.obj");
  EXPECT_EQ(sequence_pattern("a/a", 9'999), "a/a.####.obj");
  EXPECT_EQ(sequence_pattern("a/a", 10'000), "a/a.#####.obj");
  EXPECT_EQ(sequence_pattern("a/a", 123'456), "a/a.######.obj");
}

TEST(FilePattern, NamesSortAsTheirNumbersDo) {
  const std::string pattern = sequence_pattern("a/a", 12'000);
  std::string before;
  for (int frame = 1; frame <= 12'000; ++frame) {
    const std::string name = fill_pattern(pattern, frame);
    ASSERT_LT(before, name);
    before = name;
  }
  EXPECT_EQ(fill_pattern(pattern, 1), "a/a.00001.obj");
  EXPECT_EQ(before, "a/a.12000.obj");
}

TEST(FilePattern, GrowsWithTheNumber) { EXPECT_EQ(fill_pattern("a.##.obj", 123), "a.123.obj"); }

TEST(FilePattern, WithoutDigitsIsTheNameItself) { EXPECT_EQ(fill_pattern("run.json", 7), "run.json"); }

TEST(FilePattern, FindsFilesOfTheSequenceAndNoOthers) {
  const ScratchFolder scratch;
  for (const char* name : {"a/a.0002.obj", "a/a.0001.obj", "a/a.00001.obj", "a/a.001.obj", "a/a.000x.obj", "a/a.obj",
                           "a/b.0001.obj", "a/a.0003.obj.bak", "a.0001.obj"}) {
    write_text(scratch / name, "");
  }
  std::filesystem::create_directory(scratch / "a/a.0009.obj");
  EXPECT_THAT(matching_files(scratch.path(), "a/a.####.obj"), ElementsAre(scratch / "a/a.0001.obj", scratch / "a/a.0002.obj"));
  EXPECT_THAT(matching_files(scratch.path(), "missing/a.####.obj"), IsEmpty());
}

TEST(FilePattern, DoesNotFollowAFolderThatIsALink) {
  const ScratchFolder scratch;
  const ScratchFolder elsewhere;
  write_text(elsewhere / "a.0001.obj", "");
  std::filesystem::create_directory_symlink(elsewhere.path(), scratch / "a");
  EXPECT_THAT(matching_files(scratch.path(), "a/a.####.obj"), IsEmpty());
}

TEST(FilePattern, StaysInsideItsFolder) {
  for (const char* inside : {"run.json", "a/a.####.obj", "obstacles/a/a.####.obj"}) EXPECT_TRUE(stays_inside(inside)) << inside;
  for (const char* outside : {"", "/etc/passwd", "../a.obj", "a/../../b.obj", "a/", ".", ".."}) {
    EXPECT_FALSE(stays_inside(outside)) << outside;
  }
}

}  // namespace
}  // namespace sprung
