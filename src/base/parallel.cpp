#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace sprung {

void detail::run_chunks(Index count, Index chunk, void (*call)(void* body, Index begin, Index end), void* body) {
  if (count <= 0) return;
  const Index chunks = (count - 1) / chunk + 1;
  const auto run = [=](Index number) {
    const Index begin = number * chunk;
    call(body, begin, begin + std::min(chunk, count - begin));
  };
  if (chunks == 1) {
    run(0);
  } else {
    oneapi::tbb::parallel_for(Index{0}, chunks, run);
  }
}

struct ThreadLimit::Control {
  oneapi::tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          oneapi::tbb::global_control(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads))}) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace sprung
