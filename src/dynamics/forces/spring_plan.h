// How a network's springs are walked: particles in blocks, and for each block the springs that touch it. A spring between two
// blocks is computed in both and written to the block's own end, so that no two threads write to the same place, and the bits do
// not depend on their number.
#pragma once

#include "dynamics/forces/spring_kernel.h"
#include "network/spring_network.h"

#include <vector>

namespace sprung {

struct SpringPlan {
  /// Springs between consecutive particles: spring + i joins first + i and second + i. At most kSpringBatch.
  struct Run {
    Index first;
    Index second;
    Index spring;
    Index count;
    bool writes_first;
    bool writes_second;
    bool same_rest_length;  ///< of all springs of the run; the constants are then read once
    bool same_stiffness;
    bool same_damping;
  };

  /// A spring that is in no run.
  struct Single {
    Index first;
    Index second;
    Index spring;
    bool writes_first;
    bool writes_second;
  };

  struct Block {
    std::vector<Run> runs;
    std::vector<Single> singles;
  };

  /// Springs without stiffness and damping are left out.
  explicit SpringPlan(const SpringNetwork& network);

  std::vector<Block> blocks;  ///< that any spring touches
};

}  // namespace sprung
