// Damping that is given as a part of what stops a body from swinging.
#pragma once

#include "network/spring_network.h"

#include <array>
#include <optional>

namespace sprung {

/// The frequency omega [rad/s] of a body's breathing: every spring is stretched by the same part of its length, and particles move
/// straight away from the mean of the body's pinned particles or, without any, from its centre of mass. Rayleigh's quotient of that
/// motion at time 0, omega^2 = sum k_s d^2 / sum m r^2 with rest lengths d and distances r, which does not depend on the resolution
/// of a body made of `modulus` and `density`. A rope's is 10 % above its slowest motion along itself, free or pinned. 0 for a body
/// without stiffness or extent.
[[nodiscard]] double breathing_frequency(const SpringNetwork& network, const Body& body);

/// The frequency omega [rad/s] of bending to the same curvature all along, with particles moving across by half of it times r^2:
/// omega^2 = sum k l^2 / sum m (r^2 / 2)^2 over the body's angle bends of mean bond length l. 0 for a body without them.
[[nodiscard]] double bending_frequency(const SpringNetwork& network, const Body& body);

/// Gives springs of the kinds that have a damping ratio zeta, in the order of SpringKind, their k_d = 2 zeta k_s / omega, and angle
/// bends theirs by the ratio of `bend`.
void damp_by_ratio(const std::array<std::optional<double>, 3>& ratios, const Body& body, SpringNetwork& network);

}  // namespace sprung
