// The interface of contact that acts as a force.
#pragma once

#include "dynamics/forces/force.h"
#include "dynamics/state/simulation_state.h"

#include <vector>

namespace sprung {

class ContactForce : public Force {
 public:
  /// Particles in contact at the time of the last prepare(), ascending. `positions` in m, 3 x n.
  [[nodiscard]] virtual std::vector<Index> touching(const Points& positions) const = 0;

  /// The normals of obstacles at these particles, at that time.
  [[nodiscard]] virtual std::vector<ContactNormal> normals(const Points& positions) const = 0;
};

}  // namespace sprung
