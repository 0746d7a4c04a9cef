// The exact numbers of an OBJ file. tinyobjloader rounds decimals digit by digit, reads malformed numbers as 0, wraps huge indices
// and has no callback for lines. So numbers and lines are read here, and everything is checked before tinyobjloader reads the
// file.
#pragma once

#include "base/types.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

struct ObjNumbers {
  std::vector<Vector3> positions;                ///< `v` lines
  std::vector<std::array<double, 2>> texcoords;  ///< `vt` lines
  std::vector<std::array<Index, 2>> lines;       ///< `l` polylines, cut into edges
};

/// OBJ text with one element per line: no comments, continued lines joined, '\n' at line
/// ends. Line numbers are kept.
[[nodiscard]] std::string plain_obj_text(const std::string& text);

/// Requires text of `plain_obj_text`. Throws InputError that names `file` and each line with a number or index that is
/// malformed or not finite, a face with fewer than three corners, or a line element that refers to a missing vertex.
[[nodiscard]] ObjNumbers read_obj_numbers(const std::filesystem::path& file, const std::string& plain_text);

}  // namespace sprung
