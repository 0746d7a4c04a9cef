// The force of a pin or an attachment.
#pragma once

#include "base/types.h"

#include <string>

namespace sprung {

/// The mean force [N] with which a pin acts on its body, or an attachment on its first ends.
struct Reaction {
  std::string name;  ///< of the pin or attachment
  Vector3 force = Vector3::Zero();
};

}  // namespace sprung
