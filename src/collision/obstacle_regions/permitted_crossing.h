// Crossings of obstacles that are permitted until the element is free again.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// A particle that may be behind an obstacle: a corner of an element that a pin has pulled through it.
struct PermittedCrossing {
  Index obstacle = kNone;
  Index particle = kNone;
};

using PermittedCrossings = std::vector<PermittedCrossing>;

}  // namespace sprung
