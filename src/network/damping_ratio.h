// Damping as a fraction of critical damping.
#pragma once

#include "network/model/spring_network.h"

#include <array>
#include <optional>

namespace sprung {

/// The frequency omega [rad/s] of a body's breathing motion: all springs have the same strain, and particles move radially from
/// the mean of the body's pinned particles or, without pins, from its centre of mass. It is the Rayleigh quotient at time 0,
/// omega^2 = sum k_s d^2 / sum m r^2, with rest lengths d and distances r. It does not depend on the resolution of a body made
/// with `modulus` and `density`. For a rope it is 10 % above the lowest longitudinal frequency, free or pinned. 0 for a body
/// without stiffness or extent.
[[nodiscard]] double breathing_frequency(const SpringNetwork& network, const Body& body);

/// The frequency omega [rad/s] of bending with uniform curvature c, where particles move transversally by c r^2 / 2: omega^2 =
/// `bending_resistance` / sum m (r^2 / 2)^2. 0 for a body without bends.
[[nodiscard]] double bending_frequency(const SpringNetwork& network, const Body& body);

/// Sets k_d = 2 zeta k_s / omega for the kinds of springs with a damping ratio zeta, in the order of SpringKind. Angle bends and
/// face bends use the ratio of `bend`.
void damp_by_ratio(const std::array<std::optional<double>, 3>& ratios, const Body& body, SpringNetwork& network);

}  // namespace sprung
