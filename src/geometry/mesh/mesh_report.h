// A report for the user on an imported mesh and its repairs.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// Counts of what cleaning found and repaired.
struct MeshReport {
  Index vertices_read = 0;
  Index faces_read = 0;        ///< triangles after triangulation
  Index welded_vertices = 0;   ///< merged with another one at the same position
  Index unused_vertices = 0;   ///< dropped: no face uses them
  Index degenerate_faces = 0;  ///< dropped: no area
  Index duplicate_faces = 0;   ///< dropped: the same three vertices as another face, or the same quad cut along its other diagonal
  Index flipped_faces = 0;     ///< reversed to agree with their neighbours, or to face outward
  Index non_manifold_edges = 0;  ///< shared by more than two faces
  Index border_edges = 0;        ///< used by one face only
  Index components = 0;
  bool closed = false;  ///< every edge has two faces that agree, and they enclose a volume: inside and outside are defined
  Box3 bounds;          ///< [m]
  std::vector<std::string> notes;  ///< remarks for the user: components that could not be oriented, edges with too many faces
};

/// Sets the members from `non_manifold_edges` to `bounds` from the mesh as it is now, and adds notes.
void describe_surface(const TriangleMesh& mesh, MeshReport& report);

/// Where the size of a thing comes from: a file, whose unit may be another one, or numbers that a user typed.
enum class SizeSource : std::uint8_t { file, shape };

/// Extents [m] of the other things in a scene; 0 if there is nothing else.
struct OtherSizes {
  double smallest = 0.0;
  double largest = 0.0;
};

/// A question about the unit of a file, or advice about the size of a shape, with these bounds and this scale. None for empty
/// bounds. Asked if the largest extent is (1) below a millimetre, (2) above 100 m, (3) above 10 m and more than 100 times that of
/// anything else, or (4) more than 100 times below anything else, where the smallest other thing is at most 10 m large.
[[nodiscard]] std::optional<std::string> unit_note(const Box3& bounds, double scale = 1.0, const OtherSizes& others = {},
                                                   SizeSource source = SizeSource::file);

}  // namespace sprung
