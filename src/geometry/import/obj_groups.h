// The named parts of an OBJ mesh.
#pragma once

#include "base/types.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sprung {

/// For each group (`g`, each of its names), object (`o`) and material (`usemtl`): the vertices of its faces, lines and points,
/// ascending, each once. Elements under the same name belong together. A name without elements is left out.
using ObjGroups = std::map<std::string, std::vector<Index>>;

/// Requires a file that `read_obj` accepts. Throws as it does.
[[nodiscard]] ObjGroups read_obj_groups(const std::filesystem::path& file);

}  // namespace sprung
