// Detects that a simulation diverged.
#pragma once

#include "base/error.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

#include <optional>
#include <vector>

namespace sprung {

class DivergenceCheck {
 public:
  /// Keeps a reference to the network.
  explicit DivergenceCheck(const SpringNetwork& network);

  /// The first particle whose position or velocity is not finite, and its most stretched spring at the positions `before` [m] of
  /// the previous step. The caller sets step, time and remedy of the failure.
  [[nodiscard]] std::optional<StepFailure> not_finite(const SimulationState& state, const Points& before) const;

  /// The most stretched spring that has stiffness and is (1) over 1,000 times longer than at rest, now and at first, and than at
  /// time 0, and (2) longer than the longest spring of its body. No material stretches so far: the step is too large. Rule (2)
  /// spares slivers, whose edges of micrometres grow to millimetres where the mesh bends.
  [[nodiscard]] std::optional<StepFailure> overstretched(const Points& positions) const;

  /// The fastest particle and its most stretched spring.
  [[nodiscard]] StepFailure fastest(const SimulationState& state) const;

 private:
  [[nodiscard]] StepFailure blame(Index particle, Index spring, const Points& positions) const;
  [[nodiscard]] Index worst_spring_at(Index particle, const Points& positions) const;
  /// Square of the spring's length relative to its bound.
  [[nodiscard]] double squared_ratio(Index spring, const Points& positions) const;

  const SpringNetwork& network_;
  std::vector<double> longest_squared_;  ///< per spring, before it yields [m^2]
  std::vector<Index> bounded_;           ///< springs with a finite bound
};

}  // namespace sprung
