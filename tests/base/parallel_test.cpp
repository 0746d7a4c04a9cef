#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace sprung {
namespace {

TEST(ParallelChunks, CoverEverythingExactlyOnce) {
  for (const Index count : {1, 2, 99, 100, 101, 1000}) {
    std::vector<int> visits(count, 0);
    parallel_chunks(count, 100, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), count);
  }
}

TEST(ParallelChunks, DependOnTheSizeAlone) {
  const auto chunks_with = [](int threads) {
    const ThreadLimit limit(threads);
    std::mutex mutex;
    std::set<std::pair<Index, Index>> chunks;
    parallel_chunks(25, 10, [&](Index begin, Index end) {
      const std::lock_guard lock(mutex);
      chunks.emplace(begin, end);
    });
    return chunks;
  };
  const std::set<std::pair<Index, Index>> expected{{0, 10}, {10, 20}, {20, 25}};
  EXPECT_EQ(chunks_with(1), expected);
  EXPECT_EQ(chunks_with(2), expected);
}

TEST(ParallelChunks, DoNothingForACountOfZero) {
  parallel_chunks(0, 10, [](Index, Index) { FAIL() << "called"; });
}

TEST(ParallelChunks, ReachTheLargestIndex) {
  // begin + chunk would overflow the index type here.
  const Index count = std::numeric_limits<Index>::max();
  std::atomic<std::int64_t> covered{0};
  parallel_chunks(count, 1 << 30, [&](Index begin, Index end) { covered += end - begin; });
  EXPECT_EQ(covered, count);
}

TEST(ParallelChunks, RethrowExceptions) {
  for (const Index count : {5, 1000}) {
    const auto throwing = [](Index begin, Index end) {
      if (begin <= 3 && 3 < end) throw std::runtime_error("at 3");
    };
    EXPECT_THROW(parallel_chunks(count, 10, throwing), std::runtime_error);
  }
}

TEST(ThreadLimit, OfOneRunsLoopsOnTheCallersThread) {
  const ThreadLimit limit(1);
  std::set<std::thread::id> threads;
  parallel_chunks(1000, 1, [&](Index, Index) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

TEST(ThreadLimit, EndsWithItsScope) {
  // The lowest of all existing limits applies, so the inner one must not outlive its scope.
  const ThreadLimit outer(2);
  { const ThreadLimit inner(1); }
  std::mutex mutex;
  std::set<std::thread::id> threads;
  for (int attempt = 0; attempt < 200 && threads.size() < 2; ++attempt) {
    parallel_chunks(64, 1, [&](Index, Index) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
    });
  }
  EXPECT_EQ(threads.size(), 2U);
}

}  // namespace
}  // namespace sprung
