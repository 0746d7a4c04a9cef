// Faces without area.
#pragma once

#include "geometry/mesh/mesh_sequence.h"

namespace sprung {

/// Removes triangles that are a line or a point in every frame, whose normal would be rounding error, and returns their number.
/// Modellers put them where a vertex of one face lies on the edge of another (a
/// T-junction): there the other face is split at that vertex, so that a closed surface stays closed.
Index remove_flat_faces(MeshSequence& mesh);

}  // namespace sprung
