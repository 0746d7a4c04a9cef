// Where obstacles that move take particles, and how far.
#pragma once

#include "base/types.h"

namespace sprung {

/// A particle that an obstacle carries together with an element.
struct MovedVertex {
  Index particle = kNone;
  double distance = 0.0;  ///< of the element from the obstacle [m]
  Vector3 place = Vector3::Zero();
};

/// What an obstacle that comes nearer asks of a particle.
struct Push {
  Index particle = kNone;
  double distance = 0.0;         ///< of the element from the obstacle [m]
  Vector3 by = Vector3::Zero();  ///< [m]
  double most = 0.0;             ///< no farther than this, the size of an element [m]
};

}  // namespace sprung
