// The rules that bodies, springs and pins must keep before they become a network. Internal to network/.
#pragma once

#include "base/problem_list.h"
#include "network/body_shape.h"
#include "network/spring_network.h"

#include <string>
#include <vector>

namespace sprung {

/// Particles, springs and material of a body; `key` is the start of the keys, such as `bodies.rope`. Of many particles or springs
/// that break the same rule the first is named and the others are counted.
void check_body(const std::string& key, const BodyShape& shape, const ContactMaterial& material, ProblemList& problems);

/// Pins of a network of so many particles.
void check_pins(const std::vector<Pin>& pins, Index particle_count, ProblemList& problems);

}  // namespace sprung
