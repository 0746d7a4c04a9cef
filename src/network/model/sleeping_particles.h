// Particles that a simulator holds at rest.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Particle i sleeps if asleep[i] is not 0. An empty vector wakes all. The inverse mass of a particle that sleeps is 0, as if it
/// were pinned.
void set_asleep(std::vector<char> asleep, SpringNetwork& network);

/// The network with all particles awake.
[[nodiscard]] SpringNetwork awake(SpringNetwork network);

/// Whether all particles of a body sleep. True of a body without particles.
[[nodiscard]] bool is_asleep(const SpringNetwork& network, const Body& body);

}  // namespace sprung
