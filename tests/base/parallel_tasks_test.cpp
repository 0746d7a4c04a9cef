#include "base/parallel_tasks.h"

#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace sprung {
namespace {

TEST(ParallelTasks, RunEachOnce) {
  for (const Index count : {0, 1, 2, 7, 100}) {
    std::vector<int> runs(static_cast<std::size_t>(count), 0);
    parallel_tasks(count, [&](Index k) { ++runs[static_cast<std::size_t>(k)]; });
    EXPECT_EQ(std::ranges::count(runs, 1), count);
  }
}

// Code with memory of its thread relies on it: a loop that waits may not run another task in between.
TEST(ParallelTasks, NeverInterruptEachOtherInTheirLoops) {
  thread_local Index running = kNone;
  std::atomic<int> interrupted = 0;
  parallel_tasks(200, [&](Index k) {
    interrupted += running != kNone ? 1 : 0;
    running = k;
    std::atomic<int> sum = 0;
    parallel_chunks(50, 1, [&](Index begin, Index /*end*/) {
      std::this_thread::yield();
      sum += begin;
    });
    interrupted += running != k || sum != 50 * 49 / 2 ? 1 : 0;
    running = kNone;
  });
  EXPECT_EQ(interrupted, 0);
}

TEST(ParallelTasks, AllRunAndTheFirstErrorIsThrown) {
  std::atomic<int> runs = 0;
  try {
    parallel_tasks(20, [&](Index k) {
      ++runs;
      if (k == 3 || k == 15) throw std::runtime_error(std::to_string(k));
    });
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "3");
  }
  EXPECT_EQ(runs, 20);
}

}  // namespace
}  // namespace sprung
