// The pieces that the springs of a body leave apart.
#pragma once

#include "network/spring_network.h"

namespace sprung {

struct SpringPieces {
  Index count = 0;     ///< of the sets of two or more particles that springs and angle bends join
  Index alone = 0;     ///< particles without a spring and an angle bend
  bool touch = false;  ///< two particles of different sets, or one that is alone and another, have the same position
};

[[nodiscard]] SpringPieces spring_pieces(const SpringNetwork& network, const Body& body);

}  // namespace sprung
