// The order in which a network's springs are evaluated: particles in blocks, and for each block the springs that touch it. A
// spring between two blocks is evaluated in both, and each block writes its own end only. So no two threads write to the same
// particle, and the bits do not depend on the number of threads.
#pragma once

#include "dynamics/forces/spring_kernel.h"
#include "network/model/spring_network.h"

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
    bool same_rest_length;  ///< all springs of the run have this in common for ever: the value is below
    bool same_stiffness;
    bool same_damping;
    bool tension_only;   ///< all springs of the run are, or none
    double rest_length;  ///< [m], of the first spring
    double stiffness;    ///< [N/m]
    double damping;      ///< [N s/m]
  };

  /// A spring outside of all runs.
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
    std::vector<Single> tension_only_singles;
  };

  /// Springs without stiffness and damping are left out. Both have an entry per spring.
  SpringPlan(const SpringNetwork& network, const std::vector<double>& stiffness, const std::vector<double>& damping);

  std::vector<Block> blocks;  ///< blocks that a spring touches
};

}  // namespace sprung
