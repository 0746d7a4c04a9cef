#include "output/output_folder.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "output/run_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::listing;
using testing::ScratchFolder;
using testing::write_text;

const std::vector<std::string> kPatterns{"run.json", "diagnostics.csv", "rope/rope.####.obj", "obstacles/floor.obj",
                                         "obstacles/fan/fan.####.obj"};

void leave_a_run(const std::filesystem::path& folder, const std::vector<std::string>& patterns = kPatterns) {
  write_text(folder / "run.json", RunSummary(RunFacts{}, 0.01, patterns).text({}));
  for (const char* name : {"diagnostics.csv", "rope/rope.0001.obj", "rope/rope.0002.obj", "obstacles/floor.obj",
                           "obstacles/fan/fan.0001.obj", "obstacles/fan/fan.0002.obj"}) {
    write_text(folder / name, "");
  }
}

std::string refusal(const std::filesystem::path& folder, bool overwrite) {
  try {
    const OutputFolder refused(folder, overwrite);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(OutputFolder, IsMadeWithTheFoldersAboveIt) {
  const ScratchFolder scratch;
  const OutputFolder folder(scratch / "a/b c/ö", false);
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b c/ö"));
}

TEST(OutputFolder, MayBeThereWhenEmpty) {
  const ScratchFolder scratch;
  EXPECT_NO_THROW(OutputFolder(scratch.path(), false));
}

TEST(OutputFolder, IsRefusedWhenNotEmptyAndKeepsEverything) {
  const ScratchFolder scratch;
  leave_a_run(scratch.path());
  const std::vector<std::string> before = listing(scratch.path());
  EXPECT_THAT(refusal(scratch.path(), false), HasSubstr("not empty"));
  EXPECT_THAT(listing(scratch.path()), ElementsAreArray(before));
}

TEST(OutputFolder, IsRefusedWhenItIsAFile) {
  const ScratchFolder scratch;
  write_text(scratch / "file", "text");
  EXPECT_THAT(refusal(scratch / "file", false), HasSubstr((scratch / "file").string()));
  EXPECT_THAT(refusal(scratch / "file", true), HasSubstr((scratch / "file").string()));
  EXPECT_THAT(refusal(scratch / "file/below", true), HasSubstr("Not a directory"));
  EXPECT_EQ(testing::read_text(scratch / "file"), "text");
}

TEST(OutputFolder, OverwritingRemovesAllOfARun) {
  const ScratchFolder scratch;
  leave_a_run(scratch.path());
  const OutputFolder folder(scratch.path(), true);
  EXPECT_THAT(listing(scratch.path()), IsEmpty());
}

TEST(OutputFolder, OverwritingKeepsFilesThatNoRunWrote) {
  const ScratchFolder scratch;
  leave_a_run(scratch.path());
  for (const char* own : {"notes.txt", "obstacles/mine.obj", "rope/rope.0001.blend", "rope/rope.1.obj"}) {
    write_text(scratch / own, "");
  }
  const OutputFolder folder(scratch.path(), true);
  EXPECT_THAT(listing(scratch.path()),
              ElementsAre("notes.txt", "obstacles/", "obstacles/mine.obj", "rope/", "rope/rope.0001.blend", "rope/rope.1.obj"));
}

TEST(OutputFolder, OverwritingARunThatWasKilledRemovesItsTemporaryFiles) {
  const ScratchFolder scratch;
  leave_a_run(scratch.path());
  for (const char* name : {".run.json.tmp", "rope/.rope.0003.obj.tmp", "obstacles/.floor.obj.tmp", ".diagnostics.csv.tmp"}) {
    write_text(scratch / name, "half");
  }
  const OutputFolder folder(scratch.path(), true);
  EXPECT_THAT(listing(scratch.path()), IsEmpty());
}

TEST(OutputFolder, RunThatWasKilledBeforeItsFirstFileDoesNotBlockTheFolder) {
  const ScratchFolder scratch;
  write_text(scratch / ".run.json.tmp", "{");
  EXPECT_NO_THROW(OutputFolder(scratch.path(), false));
}

TEST(OutputFolder, WithoutARunIsNotOverwritten) {
  const ScratchFolder scratch;
  for (const char* json : {"", "{", "[]", "3", R"({"program": "other", "files": []})", R"({"program": "sprung"})",
                           R"({"program": "sprung", "files": [1]})"}) {
    write_text(scratch / "run.json", json);
    EXPECT_THAT(refusal(scratch.path(), true), HasSubstr("no run")) << json;
    EXPECT_THAT(listing(scratch.path()), ElementsAre("run.json"));
  }
}

TEST(OutputFolder, SummaryThatNamesFilesElsewhereRemovesNoneOfThem) {
  const ScratchFolder scratch;
  write_text(scratch / "precious.obj", "");
  leave_a_run(scratch / "out", {"run.json", "../precious.obj", (scratch / "precious.obj").string(), "rope/../../precious.obj"});
  const OutputFolder folder(scratch / "out", true);
  EXPECT_TRUE(std::filesystem::exists(scratch / "precious.obj"));
}

TEST(OutputFolder, DoesNotWriteOverAFileThatIsNotItsOwn) {
  const ScratchFolder scratch;
  write_text(scratch / "rope/rope.0007.obj", "");
  write_text(scratch / "run.json", RunSummary(RunFacts{}, 0.01, {"run.json"}).text({}));
  const OutputFolder folder(scratch.path(), true);
  EXPECT_THROW(folder.expect_free(kPatterns), FileError);
  EXPECT_NO_THROW(folder.expect_free({"run.json", "cloth/cloth.####.obj"}));
}

}  // namespace
}  // namespace sprung
