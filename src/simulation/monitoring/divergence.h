// Tells a simulation that blew up from one that moves fast.
#pragma once

#include "base/error.h"
#include "network/simulation_state.h"
#include "network/spring_network.h"

#include <optional>
#include <vector>

namespace sprung {

class DivergenceCheck {
 public:
  /// Keeps a reference to the network.
  explicit DivergenceCheck(const SpringNetwork& network);

  /// What diverged, if anything: a position or velocity that is not finite. `before` [m] are the positions of the step before, by
  /// which the spring to blame is found. Step, time and remedy are left to the caller.
  [[nodiscard]] std::optional<StepFailure> not_finite(const SimulationState& state, const Points& before) const;

  /// A spring with stiffness that is more than 1,000 times as long as at rest and as at time 0: no material holds that, a step that
  /// is too large makes it.
  [[nodiscard]] std::optional<StepFailure> overstretched(const Points& positions) const;

  /// The fastest particle and the spring at it that is stretched most.
  [[nodiscard]] StepFailure fastest(const SimulationState& state) const;

 private:
  [[nodiscard]] StepFailure blame(Index particle, Index spring, const Points& positions) const;
  [[nodiscard]] Index worst_spring_at(Index particle, const Points& positions) const;

  const SpringNetwork& network_;
  std::vector<double> longest_squared_;  ///< of each spring [m^2]
  std::vector<Index> bounded_;           ///< springs for which that is finite
};

}  // namespace sprung
