#include "sweep/process_pool.h"

#include "base/scratch_folder.h"
#include "output/folder_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using testing::ScratchFolder;

class ProcessPools : public ::testing::Test {
 protected:
  /// Runs texts of the shell, numbered from 1.
  void run(int jobs, const std::vector<std::string>& texts) {
    const auto command = [&](int number) {
      return std::vector<std::string>{"/bin/sh", "-c", texts[static_cast<std::size_t>(number - 1)]};
    };
    const auto started = [this](int number) {
      order_.push_back(number);
      most_ = std::max(most_, static_cast<int>(order_.size() - ends_.size()));
    };
    const auto ended = [this](int number, const ProcessEnd& end) {
      ends_[number] = end;
      return false;
    };
    ProcessPool pool(jobs, {.command = command,
                            .folder = [this](int number) { return scratch_ / std::to_string(number); },
                            .started = started,
                            .ended = ended,
                            .tick = [this] { tick_(); },
                            .stop = [this] { return stop_(); }});
    std::vector<int> numbers(texts.size());
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<int>(k + 1);
    pool.run(numbers);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return (scratch_ / name).string(); }

  ScratchFolder scratch_;
  std::function<void()> tick_ = [] {};
  std::function<bool()> stop_ = [] { return false; };
  std::vector<int> order_{};  ///< of the starts
  std::map<int, ProcessEnd> ends_{};
  int most_ = 0;  ///< at the same time
};

TEST_F(ProcessPools, TellHowEachProcessEnded) {
  run(3, {"echo said; echo told >&2; exit 7", "kill -SEGV $$", "true"});
  EXPECT_EQ(ends_[1].exit_code, 7);
  EXPECT_EQ(ends_[1].errors, "told\n");
  EXPECT_EQ(ends_[2].exit_code, -1);
  EXPECT_EQ(ends_[2].signal, SIGSEGV);
  EXPECT_EQ(ends_[3].exit_code, 0);
  EXPECT_GT(ends_[3].seconds, 0.0);
}

TEST_F(ProcessPools, RunAtMostSoManyAtATime) {
  run(2, std::vector<std::string>(7, "exit 0"));
  EXPECT_THAT(order_, ElementsAre(1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(ends_.size(), 7u);
  EXPECT_EQ(most_, 2);
}

TEST_F(ProcessPools, WaitForAFolderThatIsLocked) {
  testing::write_text(scratch_ / "1/file", "");
  std::optional<FolderLock> lock(std::in_place, scratch_ / "1");
  tick_ = [&] {
    if (ends_.contains(2)) lock.reset();
  };
  run(1, {"true", "true"});
  EXPECT_THAT(order_, ElementsAre(2, 1)) << "the others go on meanwhile";
  EXPECT_EQ(ends_[1].exit_code, 0);
}

TEST_F(ProcessPools, AskProcessesToEnd) {
  stop_ = [this] { return std::filesystem::exists(file("begun")); };
  run(1, {"trap 'exit 130' TERM; touch " + file("begun") + "; while :; do sleep 0.02; done", "true"});
  EXPECT_EQ(ends_[1].exit_code, 130);
  EXPECT_THAT(order_, ElementsAre(1)) << "no other begins";
}

}  // namespace
}  // namespace sprung
