// The force of a pin.
#pragma once

#include "base/types.h"

#include <string>

namespace sprung {

/// The mean force [N] with which a pin acts on its body.
struct Reaction {
  std::string name;  ///< of the pin
  Vector3 force = Vector3::Zero();
};

}  // namespace sprung
