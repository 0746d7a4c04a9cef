// Text about the steps of a scene.
#pragma once

#include "scene/load_scene.h"

#include <string>

namespace sprung {

/// `8 steps of 0.00416667 s (automatic)`
[[nodiscard]] std::string describe_steps(const LoadedScene& loaded);

}  // namespace sprung
