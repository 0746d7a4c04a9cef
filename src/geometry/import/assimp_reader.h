// Triangles from any format that assimp knows.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

#include <filesystem>
#include <string>

namespace sprung {

/// Reads all meshes of a file, each as often as its nodes place it, with their transforms applied; points and lines are left out,
/// nothing is welded. Throws InputError when the extension is unknown or the file cannot be read whole, or holds a position that is
/// not finite or an index out of range. `text`, if it is not empty, is read in place of the file's bytes.
[[nodiscard]] TriangleMesh read_with_assimp(const std::filesystem::path& file, const std::string& text = "");

}  // namespace sprung
