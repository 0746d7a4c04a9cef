// The pieces that the springs of a body leave apart.
#pragma once

#include "network/model/spring_network.h"

namespace sprung {

struct SpringPieces {
  Index count = 0;     ///< of the sets of two or more particles that springs and angle bends join
  Index alone = 0;     ///< particles without a spring and an angle bend
  bool touch = false;  ///< two particles of different sets, or one that is alone and another, are at the same place
  /// How far apart particles at the same place may be [m]: a power of ten near a millionth of the body's extent, and less than the
  /// shortest spring.
  double touch_distance = 0.0;
  Index count_welded = 0;  ///< sets and particles alone, if those at the same place were joined
};

/// Measures at time 0. The distances are set if there is more than one piece.
[[nodiscard]] SpringPieces spring_pieces(const SpringNetwork& network, const Body& body);

}  // namespace sprung
