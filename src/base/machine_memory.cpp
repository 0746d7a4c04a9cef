#include "base/machine_memory.h"

#include <sys/sysinfo.h>

#include <limits>

namespace sprung {

double machine_memory() {
  struct sysinfo told {};
  if (sysinfo(&told) != 0) return std::numeric_limits<double>::infinity();
  return static_cast<double>(told.totalram) * static_cast<double>(told.mem_unit);
}

}  // namespace sprung
