// The named parts of an OBJ mesh.
#pragma once

#include "base/types.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sprung {

/// The vertices of the file, ascending and each once, that the faces, lines and points of each group (`g`, each of its names),
/// object
/// (`o`) and material (`usemtl`) have. Parts of one name are one part. A name that has no such element is left out.
using ObjGroups = std::map<std::string, std::vector<Index>>;

/// Requires a file that `read_obj` accepts. Throws as it does.
[[nodiscard]] ObjGroups read_obj_groups(const std::filesystem::path& file);

}  // namespace sprung
