// The springs that a stretch limit constrains.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Whether a spring is of one of the given kinds, belongs to a body that is stretch_limited, has a rest length and at least one
/// free end, and neither yields nor breaks: a limit would hide the load from which these springs do so.
[[nodiscard]] bool is_limited(const SpringNetwork& network, const std::vector<SpringKind>& kinds, Index spring);

/// Likewise, with the springs between pins, in the network's order.
[[nodiscard]] std::vector<Index> measurable_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

/// Those of them with at least one free end.
[[nodiscard]] std::vector<Index> limited_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

}  // namespace sprung
