// Text that describes a simulated body.
#pragma once

#include "network/spring_network.h"

#include <string>

namespace sprung {

/// Rows of `validate`: particles and springs of the body, its masses, and for each kind of springs the smallest and largest
/// stiffness k_s [N/m], damping k_d [N s/m] and rest length [m] that the simulation uses.
[[nodiscard]] std::string body_rows(const SpringNetwork& network, const Body& body);

}  // namespace sprung
