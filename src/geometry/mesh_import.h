// Environment meshes: read by assimp from any format it knows, then welded, cleaned and oriented. Vertex order is not
// kept; simulated bodies are read by `polygon_mesh.h` instead.
#pragma once

#include "geometry/triangle_mesh.h"

#include <filesystem>
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
  bool closed = false;             ///< every edge has two faces that agree: inside and outside are defined
  Box3 bounds;                     ///< [m]
  std::vector<std::string> notes;  ///< what a person should know: suspicious units, parts that could not be oriented
};

struct ImportedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Welds vertices at the same position (exactly equal after rounding to `weld_distance` [m]; 0: equal coordinates), drops
/// degenerate and duplicate faces (whatever their winding) and unused vertices, and orients faces: neighbours agree, and closed
/// parts face outward, or into the cavity that they wall. What is left keeps the order it had.
/// Requires finite positions and indices in range.
[[nodiscard]] ImportedMesh clean_mesh(const TriangleMesh& raw, double weld_distance = 0.0);

/// Reads a mesh in any format that assimp knows, with all node transforms applied and axes as the format has them (glTF: Y up; OBJ,
/// STL, PLY, OFF and 3DS: as stored), and cleans it. Positions have the precision of a float. Throws InputError naming the file
/// when it is missing, unreadable, truncated, of an unknown format, has no triangle with an area, or holds a position that is not
/// finite or an index out of range.
[[nodiscard]] ImportedMesh import_mesh(const std::filesystem::path& file);

}  // namespace sprung
