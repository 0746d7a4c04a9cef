// What obstacles let through, because something drags it through them.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// A corner of an element that an obstacle crosses.
struct PermittedCrossing {
  Index obstacle = kNone;
  Index particle = kNone;
};

using PermittedCrossings = std::vector<PermittedCrossing>;

}  // namespace sprung
