// The way from particles along limited springs to the pins that hold them.
#pragma once

#include "network/spring_network.h"

#include <vector>

namespace sprung {

/// While springs on the way are at most (1 + s) times their rest length, a particle is at most (1 + s) times `length` from its pin.
struct Tether {
  Index particle;
  Index pin;      ///< the pinned particle
  Index group;    ///< of pins that limited springs join
  double length;  ///< sum of the rest lengths on the shortest way [m]
};

/// A particle has no more of them: those to its nearest groups.
inline constexpr int kMostTethers = 4;

/// From each particle that is not pinned to the nearest pin of each group: the shortest ways along springs of these kinds that meet
/// no other pin (Dijkstra 1959). Ordered by particle, then by group.
[[nodiscard]] std::vector<Tether> find_tethers(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

}  // namespace sprung
