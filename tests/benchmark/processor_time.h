// Processor time, for ratios of times within a run.
#pragma once

#include <ctime>

namespace sprung::benchmarks {

/// Processor time [s] of all threads of this process, independent of other processes.
[[nodiscard]] inline double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace sprung::benchmarks
