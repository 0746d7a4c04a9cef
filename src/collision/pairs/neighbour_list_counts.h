// How much self-contact has to do, for benchmarks and tests.
#pragma once

#include "base/types.h"

namespace sprung {

struct NeighbourListCounts {
  Index pairs = 0;       ///< that may touch
  Index candidates = 0;  ///< of contact
  Index renewed = 0;     ///< particles whose pairs were looked for since the step began, once for each time
  Index folded = 0;      ///< particles whose triangles may cross each other
};

}  // namespace sprung
