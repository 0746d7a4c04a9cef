// Bodies that a simulator holds at rest.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Whether each body sleeps.
[[nodiscard]] std::vector<char> asleep(const SpringNetwork& network);

/// Lets the bodies b with `asleep[b]` sleep, and wakes all others. The inverse masses of a body that sleeps are 0, as if it were
/// pinned.
void set_asleep(const std::vector<char>& asleep, SpringNetwork& network);

/// The network with all bodies awake.
[[nodiscard]] SpringNetwork awake(SpringNetwork network);

}  // namespace sprung
