// The springs that a stretch limit constrains.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Whether a spring is of one of the given kinds, belongs to a body that is stretch_limited, has a rest length and at least one
/// free end.
[[nodiscard]] bool is_limited(const SpringNetwork& network, const std::vector<SpringKind>& kinds, Index spring);

/// The springs of the given kinds and of stretch_limited bodies with a non-zero rest length, in the network's order; springs
/// between pins included.
[[nodiscard]] std::vector<Index> measurable_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

/// Those of them with at least one free end.
[[nodiscard]] std::vector<Index> limited_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

}  // namespace sprung
