// The exact numbers of an OBJ file. tinyobjloader rounds decimals digit by digit, turns what it cannot read into 0, wraps huge
// indices and has no callback for lines, so numbers and lines are read here, and everything is checked before it sees the file.
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

/// OBJ text with one element a line: no byte order mark, no comments, continued lines joined, '\n' at line ends; line numbers are
/// kept.
[[nodiscard]] std::string plain_obj_text(const std::string& text);

/// Requires plain text. Throws InputError, naming `file` and each line, when a number or an index is malformed or not finite,
/// a face has fewer than three corners, or a line element refers to a vertex that is not there.
[[nodiscard]] ObjNumbers read_obj_numbers(const std::filesystem::path& file, const std::string& plain_text);

}  // namespace sprung
