// The published JSON Schema, scene.schema.json, for tests: the library itself checks scenes by its rules.
#pragma once

#include "scene/json/json_text.h"

#include <string>
#include <vector>

namespace sprung {

/// The schema of this source tree. Throws if the file cannot be read.
[[nodiscard]] const Json& scene_schema();

/// Violations of the schema in the document, as `path: rule`; empty if the document is valid. A failed oneOf also lists the
/// violations of each branch.
[[nodiscard]] std::vector<std::string> schema_violations(const Json& document);

}  // namespace sprung
