#include "output/folder_lock.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "output/output_folder.h"

#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <optional>
#include <utility>

namespace sprung {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ScratchFolder;

std::string refusal(const std::filesystem::path& folder) {
  try {
    const OutputFolder second(folder, false);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(FolderLock, RefusesASecondAndNamesItsProcess) {
  const ScratchFolder scratch;
  {
    const OutputFolder first(scratch.path(), false);
    EXPECT_THAT(refusal(scratch.path()), HasSubstr("process " + std::to_string(::getpid()) + " writes a run into it"));
  }
  EXPECT_EQ(refusal(scratch.path()), "");
}

TEST(FolderLock, MovesWithItsOwner) {
  const ScratchFolder scratch;
  std::optional<FolderLock> lock(std::in_place, scratch.path());
  {
    const FolderLock moved(std::move(*lock));
    lock.reset();
    EXPECT_NE(refusal(scratch.path()), "");
  }
  EXPECT_EQ(refusal(scratch.path()), "");
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

TEST(FolderLock, EndsWithAKilledProcess) {
  const ScratchFolder scratch;
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(scratch.path());
    for (;;) ::pause();
  }
  while (!std::filesystem::exists(scratch / kLockFile) || std::filesystem::file_size(scratch / kLockFile) == 0) ::usleep(1000);
  EXPECT_THAT(refusal(scratch.path()), HasSubstr("process " + std::to_string(child)));
  EXPECT_TRUE(is_locked(scratch.path()));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch / kLockFile)) << "which is why the name of the file does not count";
  EXPECT_FALSE(is_locked(scratch.path()));
  EXPECT_EQ(refusal(scratch.path()), "");
}

}  // namespace
}  // namespace sprung
