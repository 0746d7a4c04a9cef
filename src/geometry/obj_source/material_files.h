// The files that give an OBJ mesh its look: its `mtllib` files, and the textures that these name.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// A file to copy beside an OBJ file.
struct MaterialFile {
  std::filesystem::path source{};
  std::string place;                  ///< path relative to the folder of the OBJ file, in it
  std::optional<std::string> text{};  ///< what to write, if it is not the bytes of the source
  bool is_texture = false;            ///< else it is an `mtllib` file
};

struct MaterialFiles {
  std::vector<MaterialFile> files;
  std::vector<std::string> missing;  ///< names of files that do not exist
  std::vector<std::string> unusual;  ///< names of files that exist and have no place beside the OBJ file
  std::vector<std::string> outside;  ///< names in `mtllib` lines that lead out of the folder, whose copies are in it
};

/// The files that the text of the OBJ file names. A name that is absolute or has `..` is placed by its base name, and so named in
/// the copy of an MTL file. A file is looked for by its name, with `\` as `/`, and last by its base name, beside the file that
/// names it.
[[nodiscard]] MaterialFiles find_material_files(const std::filesystem::path& obj_file, std::string_view obj_text);

/// The diffuse colours (`Kd`) of the materials of the `mtllib` files, by their names: red, green, blue, mostly from 0 to 1. Of a
/// name that is given twice, the first. Throws FileError if a file cannot be read.
[[nodiscard]] std::map<std::string, std::array<double, 3>> diffuse_colours(const MaterialFiles& materials);

/// The bytes of a file. Throws FileError.
[[nodiscard]] std::string content_of(const MaterialFile& file);

}  // namespace sprung
