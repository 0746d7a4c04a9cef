// Changes of a scene by --set, before it is checked.
#pragma once

#include "scene/json/json_text.h"

#include <string>
#include <vector>

namespace sprung {

/// Applies `key.path=json`, as in `bodies.rope.pins[0].nearest=[0,1,0]`. Missing keys are added together with the objects around
/// them, except bodies and obstacles: a new one must begin with its shape. The entry after the last one of a list is appended.
/// `null` removes a key. A bare word is a string unless it is a number. Reports problems under the key `--set`.
void apply_override(const std::string& override_text, Json& document, std::vector<Problem>& problems);

}  // namespace sprung
