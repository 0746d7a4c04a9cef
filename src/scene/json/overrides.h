// What --set changes of a scene before it is checked.
#pragma once

#include "scene/json/json_text.h"

#include <string>
#include <vector>

namespace sprung {

/// Applies `key.path=json`, as in `bodies.rope.pins[0].nearest=[0,1,0]`. Keys that are missing are added, with the objects around
/// them, but for bodies and obstacles, which begin with their shape; the entry after the last of a list is appended; `null` removes
/// a key. A bare word is a string, unless it is a number. Reports what cannot be applied under the key `--set`.
void apply_override(const std::string& override_text, Json& document, std::vector<Problem>& problems);

}  // namespace sprung
