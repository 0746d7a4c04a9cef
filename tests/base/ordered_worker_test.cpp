#include "base/ordered_worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace sprung {
namespace {

TEST(OrderedWorker, RunsAllJobsInOrder) {
  std::vector<int> done;
  {
    OrderedWorker worker(3);
    for (int k = 0; k < 100; ++k) worker.add([&done, k] { done.push_back(k); });
    worker.wait();
    EXPECT_EQ(done.size(), 100U);
    worker.add([&done] { done.push_back(100); });
  }
  std::vector<int> expected(101);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected) << "also those that waited at its end";
}

// A job runs while two others wait; a fourth is added only when the first has ended.
TEST(OrderedWorker, LetsTheCallerWaitForAPlace) {
  OrderedWorker worker(2);
  std::promise<void> open;
  std::shared_future<void> opened = open.get_future().share();
  std::promise<void> begun;
  worker.add([&] {
    begun.set_value();
    opened.wait();
  });
  begun.get_future().wait();
  worker.add([] {});
  worker.add([] {});
  std::atomic<bool> is_added = false;
  auto adds = std::async(std::launch::async, [&] {
    worker.add([] {});
    is_added = true;
  });
  EXPECT_EQ(adds.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  EXPECT_FALSE(is_added);
  open.set_value();
  adds.get();
  worker.wait();
}

TEST(OrderedWorker, DropsWhatWaitsAfterAFailureAndSaysItOnce) {
  OrderedWorker worker(10);
  std::promise<void> open;
  std::atomic<int> later = 0;
  worker.add([&] {
    open.get_future().wait();
    throw std::runtime_error("full");
  });
  for (int k = 0; k < 5; ++k) worker.add([&] { ++later; });
  open.set_value();
  EXPECT_THROW(worker.wait(), std::runtime_error);
  EXPECT_EQ(later, 0);
  worker.add([&] { ++later; });
  worker.wait();
  EXPECT_EQ(later, 1);
}

}  // namespace
}  // namespace sprung
