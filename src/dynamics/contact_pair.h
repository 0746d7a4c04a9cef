// What a body and an obstacle are to each other.
#pragma once

#include "base/contact_material.h"
#include "network/spring_network.h"

namespace sprung {

/// Gap, frictions and restitution of a body and an obstacle (see ContactMaterial).
[[nodiscard]] ContactMaterial combine(const ContactMaterial& body, const ContactMaterial& obstacle);

/// Each particle's share of the gap [m]: the thickness of its body.
[[nodiscard]] Scalars particle_thickness(const SpringNetwork& network);

}  // namespace sprung
