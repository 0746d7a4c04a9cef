// Parallel loops whose results do not depend on the number of threads: the size alone determines the chunks.
#pragma once

#include "base/types.h"

#include <memory>
#include <type_traits>

namespace sprung {

namespace detail {
void run_chunks(Index count, Index chunk, void (*call)(void* body, Index begin, Index end), void* body);
}

/// Calls `body(begin, end)` once for each chunk [0, chunk), [chunk, 2 chunk), ... of [0, count), possibly concurrently. Requires
/// chunk > 0, and that no two chunks write to the same memory. Rethrows exceptions of `body`.
template <class Body>
void parallel_chunks(Index count, Index chunk, Body&& body) {
  using Function = std::remove_reference_t<Body>;
  detail::run_chunks(
      count, chunk, [](void* data, Index begin, Index end) { (*static_cast<Function*>(data))(begin, end); },
      const_cast<void*>(static_cast<const void*>(&body)));
}

/// Limits all parallel loops of the process to this number of threads during its lifetime; of several limits the least holds.
/// Requires threads >= 1.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace sprung
