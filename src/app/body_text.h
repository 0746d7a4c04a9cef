// A simulated body in words.
#pragma once

#include "network/spring_network.h"

#include <string>

namespace sprung {

/// Rows of `validate`: what the body holds, its masses, and of each kind of springs the smallest and largest stiffness k_s, damping
/// k_d and rest length, as they are simulated.
[[nodiscard]] std::string body_rows(const SpringNetwork& network, const Body& body);

}  // namespace sprung
