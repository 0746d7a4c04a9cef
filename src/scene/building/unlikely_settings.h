// Warns of what is probably not meant: sizes and densities in other units, springs that a body does not have, faulty meshes, a
// thickness beyond the edges, a wind along a flat sheet.
#pragma once

#include "base/grouped_warnings.h"
#include "scene/building/scene_builder.h"

namespace sprung {

/// Asks about the units of meshes and shapes that are very small, very large, or far larger than anything else in the scene. Flat
/// obstacles may be as wide as they like.
void note_unusual_sizes(const Scene& scene, const BuiltScene& built, GroupedWarnings& bodies, GroupedWarnings& obstacles);

/// Tells which kinds of springs the scene gives a body that its shape does not have.
void note_unused_springs(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies);

/// Tells which bodies are a hundred times lighter or heavier than all materials for their shape.
void note_unusual_densities(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies);

/// Tells which bodies of a mesh have faces that lie on others, and vertices on edges of a seam that `weld` cannot close.
void note_mesh_faults(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies);

/// Tells which bodies with self-contact are thicker than their edges are long.
void note_thick_bodies(const SpringNetwork& network, GroupedWarnings& bodies);

/// Tells which flat bodies have a wind along their plane, which does not push them to either side.
void note_wind_along_sheets(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies);

}  // namespace sprung
