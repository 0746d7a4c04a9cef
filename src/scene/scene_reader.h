// Scene files: JSON, checked against the published schema and our own rules.
#pragma once

#include "base/error.h"
#include "scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// Reads a scene; `overrides` are `key.path=json` as given to --set. Throws FileError when the file cannot be read, and InputError
/// with every problem (file, key, value, rule, remedy) when it is not valid.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same, but keys that are not known are appended to `unknown_keys`, and not thrown when nothing else is wrong: the scene may
/// be looked at further.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                               std::vector<Problem>& unknown_keys);

}  // namespace sprung
