#include "base/files/sealed_file.h"

#include "base/error.h"
#include "base/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>

namespace sprung {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::ScratchFolder;
using testing::write_text;

constexpr Seal kSeal{.kind = "testfile", .what = "a file of this test", .version = "2"};

std::string refusal(const std::filesystem::path& file, const Seal& seal = kSeal) {
  try {
    (void)read_sealed(file, seal);
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.string()));
    return error.what();
  }
  return "";
}

TEST(SealedFile, GivesItsContentBack) {
  const ScratchFolder scratch;
  const std::string content("some\0bytes\n", 11);
  write_text(scratch / "file", sealed(kSeal, content));
  EXPECT_EQ(read_sealed(scratch / "file", kSeal), content);
  write_text(scratch / "empty", sealed(kSeal, ""));
  EXPECT_EQ(read_sealed(scratch / "empty", kSeal), "");
}

TEST(SealedFile, TellsAnyChangedBit) {
  const ScratchFolder scratch;
  const std::string good = sealed(kSeal, "content");
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(static_cast<unsigned char>(bad[bit / 8]) ^ (1U << (bit % 8)));
    write_text(scratch / "file", bad);
    EXPECT_THAT(refusal(scratch / "file"), AnyOf(HasSubstr("damaged"), HasSubstr("truncated"), HasSubstr("it is not"))) << bit;
  }
}

TEST(SealedFile, TellsAnyTruncation) {
  const ScratchFolder scratch;
  const std::string good = sealed(kSeal, "content");
  for (std::size_t size = kSeal.kind.size(); size < good.size(); ++size) {
    write_text(scratch / "file", good.substr(0, size));
    EXPECT_THAT(refusal(scratch / "file"), HasSubstr("it is truncated")) << size;
  }
  write_text(scratch / "file", good + "x");
  EXPECT_THAT(refusal(scratch / "file"), HasSubstr("it is damaged"));
}

TEST(SealedFile, TellsForeignFilesAndOtherVersions) {
  const ScratchFolder scratch;
  write_text(scratch / "file", "v 1 2 3\nv 1 2 4\n");
  EXPECT_THAT(refusal(scratch / "file"), HasSubstr("it is not a file of this test"));
  write_text(scratch / "file", "");
  EXPECT_THAT(refusal(scratch / "file"), HasSubstr("it is not a file of this test"));
  write_text(scratch / "file", sealed({.kind = kSeal.kind, .what = kSeal.what, .version = "1"}, "content"));
  EXPECT_THAT(refusal(scratch / "file"), HasSubstr("version 1 wrote it, and this is version 2"));
  EXPECT_THAT(refusal(scratch / "none"), HasSubstr("No such file"));
  EXPECT_NE(refusal(scratch.path()), "");
}

}  // namespace
}  // namespace sprung
