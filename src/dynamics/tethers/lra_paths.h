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

/// Whether the pins of a body stay where they are and part into two groups at least, and all groups between which tethers of a
/// particle lead are, where they begin, as far from each other as springs within a limit of `max_stretch` reach: what hangs by them
/// cannot sag between them. Requires tethers as found, in their order.
[[nodiscard]] bool are_pins_taut(const SpringNetwork& network, const Body& body, const std::vector<Tether>& tethers,
                                 double max_stretch);

}  // namespace sprung
