// Triangles from a file that was checked.
#pragma once

#include "geometry/import/mesh_check.h"
#include "geometry/mesh/triangle_mesh.h"

#include <filesystem>

namespace sprung {

/// Reads all meshes of a file, each as often as its nodes place it, with their transforms applied; points and lines are left out,
/// nothing is welded. Throws InputError, naming `file`, when assimp cannot read what was checked, or a position is not finite.
[[nodiscard]] TriangleMesh read_with_assimp(const std::filesystem::path& file, const CheckedFile& checked);

}  // namespace sprung
