// The normal of a contact at a particle.
#pragma once

#include "base/types.h"

namespace sprung {

struct ContactNormal {
  Index particle = kNone;
  Vector3 normal = Vector3::Zero();  ///< unit length
};

}  // namespace sprung
