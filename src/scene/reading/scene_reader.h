// Reads scene files: JSON that the rules check. The published schema, scene.schema.json, accepts the same scenes.
#pragma once

#include "base/error.h"
#include "scene/format/scene.h"
#include "scene/format/text_problems.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// Reads a scene; `overrides` are `key.path=json` as given to --set. Throws FileError if the file cannot be read, and InputError
/// with every problem (file, key, value, rule, remedy) if it is invalid.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Throws FileError, as read_scene_file(), unless the file can be opened.
void check_scene_file(const std::filesystem::path& file);

/// The text of a scene file. Throws FileError if it cannot be read; of a file that does not exist, it names the one that was
/// probably meant.
[[nodiscard]] std::string read_scene_file(const std::filesystem::path& file);

/// Reads the text of a scene; problems name `file`. Adds problems to `problems` and returns a scene with defaults in their
/// location, for further checks. Throws InputError if the text contains no JSON object.
[[nodiscard]] Scene read_scene_text(const std::string& text, const std::filesystem::path& file,
                                    const std::vector<std::string>& overrides, TextProblems& problems);

}  // namespace sprung
