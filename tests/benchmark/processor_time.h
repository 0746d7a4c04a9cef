// Time for ratios within a run.
#pragma once

#include <ctime>

namespace sprung::benchmarks {

/// Seconds of this process alone, of all its threads, whatever else the machine does.
[[nodiscard]] inline double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace sprung::benchmarks
