// Scenes that no memory holds are refused before they take all of it: systems hand out more than there is, and then end what uses
// it.
#pragma once

#include "base/error.h"
#include "scene/format/scene.h"

#include <vector>

namespace sprung {

/// Adds a problem, without a file, for the largest body when ropes, cloths and solids together take more than `memory` [bytes].
void check_memory(const std::vector<BodyScene>& bodies, double memory, std::vector<Problem>& problems);

}  // namespace sprung
