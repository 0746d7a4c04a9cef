#include "base/files/file_writer.h"

#include "base/error.h"
#include "base/file_size_limit.h"
#include "base/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using testing::FileSizeLimit;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::listing;
using testing::read_text;
using testing::ScratchFolder;
using testing::write_text;

TEST(FileWriter, MakesFoldersAndLeavesNothingButTheFile) {
  const ScratchFolder scratch;
  write_file(scratch / "a/b/file.txt", "text\n");
  EXPECT_EQ(read_text(scratch / "a/b/file.txt"), "text\n");
  EXPECT_THAT(listing(scratch.path()), ElementsAre("a/", "a/b/", "a/b/file.txt"));
}

TEST(FileWriter, ReplacesAnExistingFile) {
  const ScratchFolder scratch;
  write_file(scratch / "file.txt", "long text");
  write_file(scratch / "file.txt", "short");
  EXPECT_EQ(read_text(scratch / "file.txt"), "short");
}

TEST(FileWriter, FullDiskLeavesTheOldFileAndNoTemporaryOne) {
  const ScratchFolder scratch;
  write_file(scratch / "file.txt", "old");
  {
    const FileSizeLimit limit(10'000);
    EXPECT_THROW(write_file(scratch / "file.txt", std::string(20'000, 'x')), FileError);
  }
  EXPECT_EQ(read_text(scratch / "file.txt"), "old");
  EXPECT_THAT(listing(scratch.path()), ElementsAre("file.txt"));
}

TEST(FileWriter, FullDiskLeavesNoEmptyFolder) {
  const ScratchFolder scratch;
  const FileSizeLimit limit(10'000);
  EXPECT_THROW(write_file(scratch / "new/file.txt", std::string(20'000, 'x')), FileError);
  EXPECT_THAT(listing(scratch.path()), IsEmpty());
}

TEST(FileWriter, FolderThatIsAFileIsNamedInTheError) {
  const ScratchFolder scratch;
  write_text(scratch / "file", "");
  try {
    write_file(scratch / "file/below.txt", "text");
    FAIL() << "written below a file";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr((scratch / "file").string()));
    EXPECT_THAT(error.what(), HasSubstr("Not a directory"));
  }
}

TEST(FileWriter, TargetThatIsAFolderIsLeftAlone) {
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch / "taken");
  EXPECT_THROW(write_file(scratch / "taken", "text"), FileError);
  EXPECT_THAT(listing(scratch.path()), ElementsAre("taken/"));
}

TEST(FileWriter, AppendingOnAFullDiskTakesBackThePartThatFitted) {
  const ScratchFolder scratch;
  append_to_file(scratch / "rows.csv", "first\n");
  append_to_file(scratch / "rows.csv", "second\n");
  {
    const FileSizeLimit limit(10'000);
    EXPECT_THROW(append_to_file(scratch / "rows.csv", std::string(20'000, 'x')), FileError);
  }
  EXPECT_EQ(read_text(scratch / "rows.csv"), "first\nsecond\n");
}

}  // namespace
}  // namespace sprung
