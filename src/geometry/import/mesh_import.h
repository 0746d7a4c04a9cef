// Environment meshes: checked, read by assimp, then welded, cleaned and oriented. Vertex order is not kept; simulated bodies are
// read by `polygon_mesh.h` instead.
#pragma once

#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/triangle_mesh.h"

#include <filesystem>

namespace sprung {

struct ImportedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Welds vertices with equal coordinates, drops degenerate and duplicate faces (whatever their winding) and unused vertices, and
/// orients faces: neighbours agree, and closed parts face outward, or into the cavity that they wall. What is left keeps the order
/// it had.
/// Requires finite positions and indices in range.
[[nodiscard]] ImportedMesh clean_mesh(const TriangleMesh& raw);

/// Reads an OBJ, STL, PLY, OFF, glTF 2.0 (.gltf, .glb) or 3DS file, with all node transforms applied and axes as the format has
/// them (glTF: Y up; the others: as stored), and cleans it. Positions have the precision of a float. Throws InputError naming the
/// file when it is missing, unreadable, truncated, damaged, of another format, has no triangle with an area, or holds a position
/// that is not finite or an index out of range. Assertions and crashes of assimp are ruled out by `mesh_check.h`.
[[nodiscard]] ImportedMesh import_mesh(const std::filesystem::path& file);

}  // namespace sprung
