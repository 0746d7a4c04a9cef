// Warns of what is probably not meant: meshes in other units than metres, springs that a body does not have.
#pragma once

#include "base/grouped_warnings.h"
#include "scene/building/scene_builder.h"

namespace sprung {

/// Asks about the units of meshes that are very small, very large, or far larger than anything else in the scene.
void note_unusual_sizes(const Scene& scene, const BuiltScene& built, GroupedWarnings& bodies, GroupedWarnings& obstacles);

/// Tells which kinds of springs the scene gives a body that its shape does not have.
void note_unused_springs(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies);

}  // namespace sprung
