// Tasks that run at the same time, each with parallel loops of its own.
#pragma once

#include "base/types.h"

#include <functional>

namespace sprung {

/// Calls `task(k)` once for each k in [0, count), several at the same time. Parallel loops in a task have the threads that the
/// other tasks leave over. A thread that waits for such a loop runs no other task. Rethrows the exception of the first task that
/// throws, after all tasks.
void parallel_tasks(Index count, const std::function<void(Index)>& task);

}  // namespace sprung
