// Scene files: JSON, checked by the rules. The published schema, scene.schema.json, accepts the same scenes.
#pragma once

#include "base/error.h"
#include "scene/format/scene.h"
#include "scene/format/text_problems.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// Reads a scene; `overrides` are `key.path=json` as given to --set. Throws FileError when the file cannot be read, and InputError
/// with every problem (file, key, value, rule, remedy) when it is not valid.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same, but what is wrong goes into `problems`, and the scene, which holds defaults there, may be looked at further. Throws
/// InputError when the file holds no JSON object.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                               TextProblems& problems);

}  // namespace sprung
