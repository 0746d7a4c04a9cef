#include "base/parallel_tasks.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <vector>

namespace sprung {

void parallel_tasks(Index count, const std::function<void(Index)>& task) {
  if (count <= 0) return;
  const int threads_per_task = std::max(1, oneapi::tbb::this_task_arena::max_concurrency() / count);
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
  const auto run = [&](Index k) {
    try {
      task(k);
    } catch (...) {
      errors[static_cast<std::size_t>(k)] = std::current_exception();
    }
  };
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<Index>(0, count, 1),
      [&](const oneapi::tbb::blocked_range<Index>& range) {
        // In an arena of its own, a thread that waits for a loop takes no other task.
        oneapi::tbb::task_arena arena(threads_per_task);
        arena.execute([&] { run(range.begin()); });
      },
      oneapi::tbb::simple_partitioner());
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace sprung
