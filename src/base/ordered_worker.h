// Work that another thread does meanwhile, in order.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace sprung {

/// Runs jobs one after the other on a thread of its own. A job that throws ends the work: the jobs that wait are dropped, and the
/// next call of add() or wait() rethrows; after that call it takes jobs again. Its members are for one thread.
class OrderedWorker {
 public:
  /// At most so many jobs wait. Requires most_waiting >= 1. Throws std::system_error if no thread can be started.
  explicit OrderedWorker(std::size_t most_waiting);

  /// Ends all jobs. What they throw is lost.
  ~OrderedWorker();
  OrderedWorker(const OrderedWorker&) = delete;
  OrderedWorker& operator=(const OrderedWorker&) = delete;

  /// Blocks while `most_waiting` jobs wait. Rethrows what a former job threw, and does not add the job then.
  void add(std::function<void()> job);

  /// Returns when all jobs are done. Rethrows what one of them threw.
  void wait();

 private:
  void work();
  void rethrow(std::unique_lock<std::mutex>& lock);

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool is_working_ = false;
  bool is_ending_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace sprung
