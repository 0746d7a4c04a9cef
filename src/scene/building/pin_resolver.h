// Finds the particles of a body's pins.
#pragma once

#include "scene/building/body_builder.h"

#include <vector>

namespace sprung {

/// The pins of a body, with their particles counted from 0 within the body. A particle of several pins that rest for ever belongs
/// to the first of them; a pin that is left without particles is left out. Adds a problem for each pin that contains no particle,
/// names a particle or a group that does not exist, or contains a particle that another pin holds at the same time. Requires that
/// the scene has the obstacles that pins follow.
[[nodiscard]] std::vector<Pin> resolve_pins(const Scene& scene, const BodyScene& body, const BuiltBody& placed,
                                            std::vector<Problem>& problems);

}  // namespace sprung
