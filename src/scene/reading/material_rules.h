// The key `material` of a body: writes the values of a preset into the keys that the body lacks.
#pragma once

#include "scene/format/scene.h"
#include "scene/json/json_fields.h"

#include <optional>

namespace sprung {

/// Reads `material` and `diameter`, and fills the body's missing keys. A name that is unknown, or of another kind than `shape`, is
/// reported; the body then gets values that cause no further problems.
void read_preset(Fields& fields, const std::optional<BodyShapeScene>& shape, BodyScene& body);

}  // namespace sprung
