// What importing a mesh found and did, for a person to read.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// What cleaning found and did.
struct MeshReport {
  Index vertices_read = 0;
  Index faces_read = 0;          ///< triangles after triangulation
  Index welded_vertices = 0;     ///< merged with one at the same position
  Index unused_vertices = 0;     ///< dropped: no face uses them
  Index degenerate_faces = 0;    ///< dropped: no area
  Index duplicate_faces = 0;     ///< dropped: the same three vertices again, or the same quad cut along its other diagonal
  Index flipped_faces = 0;       ///< turned to agree with their neighbours, or to face outward
  Index non_manifold_edges = 0;  ///< shared by more than two faces
  Index border_edges = 0;        ///< used by one face only
  Index components = 0;
  bool closed = false;             ///< every edge has two faces that agree, around some volume: inside and outside are defined
  Box3 bounds;                     ///< [m]
  std::vector<std::string> notes;  ///< what a person should know: parts that could not be oriented, edges with too many faces
};

/// Fills in what the surface is like as it is now, from `non_manifold_edges` to `bounds`, and adds what is to note of it.
void describe_surface(const TriangleMesh& mesh, MeshReport& report);

/// What to ask a person about the units of a mesh with these bounds when it is placed with this scale: something unless its largest
/// extent is between a millimetre and a kilometre, or nothing is in the bounds.
[[nodiscard]] std::optional<std::string> unit_note(const Box3& bounds, double scale = 1.0);

}  // namespace sprung
