#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace sprung {

namespace {

/// Tells the thread sanitizer, which does not know oneTBB, the order of a loop: chunks run after the code before the loop and
/// before the code after it, but in no order among themselves.
class LoopOrder {
 public:
#ifdef __SANITIZE_THREAD__
  void begin() { __tsan_release(&begun_); }
  void begin_chunk() { __tsan_acquire(&begun_); }
  void end_chunk() { __tsan_release(&ended_); }
  void end() { __tsan_acquire(&ended_); }

 private:
  char begun_ = 0;
  char ended_ = 0;
#else
  void begin() {}
  void begin_chunk() {}
  void end_chunk() {}
  void end() {}
#endif
};

}  // namespace

void detail::run_chunks(Index count, Index chunk, void (*call)(void* body, Index begin, Index end), void* body) {
  if (count <= 0) return;
  const Index chunks = (count - 1) / chunk + 1;
  const auto run = [=](Index number) {
    const Index begin = number * chunk;
    call(body, begin, begin + std::min(chunk, count - begin));
  };
  if (chunks == 1) {
    run(0);
    return;
  }
  LoopOrder order;
  order.begin();
  oneapi::tbb::parallel_for(Index{0}, chunks, [&](Index number) {
    order.begin_chunk();
    run(number);
    order.end_chunk();
  });
  order.end();
}

struct ThreadLimit::Control {
  oneapi::tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          oneapi::tbb::global_control(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads))}) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace sprung
