// Tolerances that several modules of contact share.
#pragma once

namespace sprung {

/// Distance that safe regions and separating planes keep beyond what is required, relative to the largest coordinate. It exceeds
/// the rounding error of a distance or of a height along a unit normal (2^-52 per operation) by far, and is well below any
/// thickness that a scene resolves.
inline constexpr double kClearance = 0x1p-30;

/// The margin of a step as a fraction of the contact gap: it keeps contacts active in a step with hardly any motion.
inline constexpr double kMarginOfGap = 0.1;

/// The margin of a step as a fraction of the largest displacement in the step.
inline constexpr double kMarginOfMotion = 0.5;

/// The margin [m] beyond the contact gap [m] within which a step detects contacts, if its forces displace the particles by up to
/// `displacement` [m]. Solver passes displace particles by less than that, so contacts farther away would stay inactive.
[[nodiscard]] constexpr double margin_of_step(double gap, double displacement) {
  return kMarginOfGap * gap + kMarginOfMotion * displacement;
}

}  // namespace sprung
