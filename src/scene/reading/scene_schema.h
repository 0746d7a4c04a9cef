// The published JSON Schema, scene.schema.json, as it was when this library was built.
#pragma once

#include "scene/json/json_text.h"

#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// Text of scene.schema.json.
[[nodiscard]] std::string_view scene_schema();

/// A place that the schema refuses, and why.
struct SchemaViolation {
  std::string path;
  std::string rule;
};

/// The innermost places of the document that the schema refuses, of the first thousand.
[[nodiscard]] std::vector<SchemaViolation> schema_violations(const Json& document);

}  // namespace sprung
