// Refuses scenes that exceed the main memory before they are built: systems allocate more than there is and then kill the program.
#pragma once

#include "base/error.h"
#include "scene/format/scene.h"

#include <vector>

namespace sprung {

/// Adds a problem, without a file, for the largest body if ropes, cloths and solids together need more than `memory` [bytes].
void check_memory(const std::vector<BodyScene>& bodies, double memory, std::vector<Problem>& problems);

}  // namespace sprung
