// Which springs a stretch limit holds.
#pragma once

#include "network/spring_network.h"

#include <vector>

namespace sprung {

/// The springs of the given kinds that have a rest length and at least one free end, in the network's order.
[[nodiscard]] std::vector<Index> limited_springs(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

}  // namespace sprung
