// The last word on positions: no particle ends behind a surface in front of which it began.
#pragma once

#include "collision/obstacle_set.h"

#include <vector>

namespace sprung {

/// See Environment::truncate.
std::vector<Index> truncate_paths(const ObstacleSet& set, const Points& before, Points& after, const std::vector<char>& held,
                                  Index& squeezed);

}  // namespace sprung
