// The scenes that a page offers beside the one it shows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

struct ExampleScene {
  std::string name;  ///< lessons begin with `lessons/`
  std::string file;
  std::string sentence{};           ///< what it shows; empty: not known
  std::filesystem::path picture{};  ///< a PNG file; empty: none
};

/// The scenes in the folder of a scene and the lessons in its folder `lessons`, or, for a lesson, those of the folder above. Sorted
/// by name. Sentences are from the folder's README.md, whose lines name scenes as `**NAME**: sentence`, and of lessons the first
/// lines of their texts. Pictures are `pictures/NAME.png`.
[[nodiscard]] std::vector<ExampleScene> scenes_beside(const std::filesystem::path& scene);

}  // namespace sprung
