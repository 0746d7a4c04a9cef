// The named parts of an OBJ mesh.
#pragma once

#include "base/types.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sprung {

struct ObjGroup {
  std::vector<Index> vertices;  ///< of its faces, lines and points, ascending, each once
  std::vector<Index> faces;     ///< as `read_obj` numbers them, ascending, each once; so do lines
  std::vector<Index> lines;
};

/// For each group (`g`, each of its names), object (`o`) and material (`usemtl`): its elements. Elements under the same name belong
/// together. A name without elements is left out.
using ObjGroups = std::map<std::string, ObjGroup>;

/// Requires a file that `read_obj` accepts. Throws as it does.
[[nodiscard]] ObjGroups read_obj_groups(const std::filesystem::path& file);

}  // namespace sprung
