// What FCL must not see: it would crash, or lose contacts without a word.
#pragma once

#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/triangle_mesh.h"

namespace sprung {

/// Throws InputError, naming every problem, for a mesh without triangles, with a position that is not finite or beyond 1e15 m, or
/// with an index out of range.
void require_usable(const TriangleMesh& mesh);

/// The same for the frames of a sequence, and for one without frames, with frames of different numbers of vertices, or with a
/// frame rate or start that is none.
void require_usable(const MeshSequence& sequence);

}  // namespace sprung
