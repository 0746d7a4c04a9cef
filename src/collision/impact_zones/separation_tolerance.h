// How near to each other the sides of a pair may come in a step.
#pragma once

#include <algorithm>

namespace sprung {

struct SeparationTolerance {
  double thickness_kept = 0.0;  ///< what sides that are held keep between them where they can [m]
  double clearance = 0.0;       ///< below this, a gap is not told from rounding [m]

  /// A gap that is larger may end as small as this, one that is smaller never smaller: else it would wear away, step by step [m].
  [[nodiscard]] double least() const { return 0.5 * clearance; }

  /// Sides with this gap [m] where the step begins may not end with a smaller one than so, but for the step's rounding.
  [[nodiscard]] double needed(double begun) const { return std::min(begun, least()) - kRounding * clearance; }

  /// What of it is kept where sides are held.
  [[nodiscard]] double kept(double begun) const { return std::min(begun, std::max(clearance, thickness_kept)); }

 private:
  static constexpr double kRounding = 0x1p-18;
};

}  // namespace sprung
