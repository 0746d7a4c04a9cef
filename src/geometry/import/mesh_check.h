// Checks that assimp leaves out: it reads past the end of a truncated PLY or OFF file, moves OFF indices into range, skips OBJ
// vertices that it cannot read, and waits for ever for the end of a PLY header.
#pragma once

#include <filesystem>
#include <string>

namespace sprung {

/// Throws InputError, naming the place, unless the bytes of a PLY file hold all the elements that its header declares.
void check_ply(const std::filesystem::path& file, const std::string& bytes);

/// Throws InputError, naming the line, unless the text of an OFF file holds all vertices and faces that it declares, and the faces
/// refer to its vertices. Binary OFF is left to assimp, which refuses it.
void check_off(const std::filesystem::path& file, const std::string& text);

}  // namespace sprung
