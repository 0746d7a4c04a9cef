// Checks meshes before FCL gets them. With an invalid mesh FCL would crash or lose contacts silently.
#pragma once

#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/triangle_mesh.h"

namespace sprung {

/// Throws InputError, which names every problem, if the mesh has no triangles, a position that is not finite or beyond 1e15 m, or
/// an index out of range.
void require_usable(const TriangleMesh& mesh);

/// Throws InputError, which names every problem, if a frame is invalid as above, the sequence has no frames or frames with
/// different numbers of vertices, or its frame rate or start is invalid.
void require_usable(const MeshSequence& sequence);

}  // namespace sprung
