#include "base/machine/machine_memory.h"

#include <sys/sysinfo.h>

#include <limits>

namespace sprung {

double machine_memory() {
  struct sysinfo info {};
  if (sysinfo(&info) != 0) return std::numeric_limits<double>::infinity();
  return static_cast<double>(info.totalram) * static_cast<double>(info.mem_unit);
}

}  // namespace sprung
