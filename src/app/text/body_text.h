// Text that describes a simulated body.
#pragma once

#include "network/model/spring_network.h"
#include "simulation/simulator.h"

#include <string>

namespace sprung {

/// Rows of `validate`: particles and springs of the body, its masses, its `material` (empty: none is named) with friction and
/// thickness, the number of pieces that no spring joins if there are several, and for each kind of springs the smallest and largest
/// stiffness k_s [N/m], damping k_d [N s/m] and rest length [m] that the simulation uses.
[[nodiscard]] std::string body_rows(const SpringNetwork& network, const Body& body, const std::string& material);

/// Rows of `validate` that say how stiff the body is: estimates for a body that hangs by one end. Empty for a body without a
/// measure, and without gravity.
[[nodiscard]] std::string stiffness_rows(const Simulator& simulator, const Body& body);

}  // namespace sprung
