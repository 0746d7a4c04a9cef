// Triangles from a checked file.
#pragma once

#include "geometry/import/mesh_check.h"
#include "geometry/mesh/triangle_mesh.h"

#include <filesystem>

namespace sprung {

/// Reads all meshes of a file, one copy per node that refers to it, with the node's transform applied. Leaves out points and
/// lines, and welds nothing. Vertices keep the order and the exact positions that `checked` gives. Throws InputError that names
/// `file` if assimp cannot read it or a position is not finite.
[[nodiscard]] TriangleMesh read_with_assimp(const std::filesystem::path& file, const CheckedFile& checked);

}  // namespace sprung
