// The gap that the sides of a pair keep in a step.
#pragma once

#include <algorithm>

namespace sprung {

struct SeparationTolerance {
  double thickness_kept = 0.0;  ///< gap that constrained sides keep if they can [m]
  double clearance = 0.0;       ///< a smaller gap may come from rounding [m]

  /// Smallest gap at the end of a step [m]. A gap that is already smaller may not shrink, or it would vanish over many steps.
  [[nodiscard]] double least() const { return 0.5 * clearance; }

  /// Smallest gap at the end of a step that begins with the gap `begun`, less a bound of the step's rounding [m].
  [[nodiscard]] double needed(double begun) const { return std::min(begun, least()) - kRounding * clearance; }

  /// The gap that constrained sides keep if the step begins with the gap `begun` [m].
  [[nodiscard]] double kept(double begun) const { return std::min(begun, std::max(clearance, thickness_kept)); }

 private:
  static constexpr double kRounding = 0x1p-18;
};

}  // namespace sprung
