// Meshes of the environment: checked, read by assimp, then welded, cleaned and oriented; `polygon_mesh.h` reads simulated bodies.
#pragma once

#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/triangle_mesh.h"

#include <filesystem>

namespace sprung {

struct ImportedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Welds vertices with equal coordinates, drops faces without area (and splits the neighbour where one closes a T-junction),
/// duplicate faces (regardless of winding) and unused vertices, and orients faces. Neighbours agree, and a closed component faces
/// outward, or into the cavity that it bounds. The remaining vertices and faces keep their order. Requires finite positions and
/// indices in range.
[[nodiscard]] ImportedMesh clean_mesh(const TriangleMesh& raw);

/// Reads an OBJ, STL, PLY, OFF, glTF 2.0 (.gltf, .glb) or 3DS file, applies all node transforms, and cleans the mesh. Axes are
/// those of the format (glTF: Y up; others: as stored). A position from a text file is the double nearest to its text (glTF has
/// floats). Throws InputError that names the
/// file if it is missing, unreadable, truncated, damaged, of another format, has no triangle with an area, or contains a position
/// that is not finite or an index out of range. `mesh_check.h` keeps away files on which assimp asserts or crashes. Thread-safe,
/// but assimp reads one file at a time.
[[nodiscard]] ImportedMesh import_mesh(const std::filesystem::path& file);

}  // namespace sprung
