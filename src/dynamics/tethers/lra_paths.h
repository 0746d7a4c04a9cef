// Shortest paths along limited springs from particles to their pins.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// A path to a pin. While its springs are at most (1 + s) times their rest length, the particle is within (1 + s) `length` of the
/// pin.
struct Tether {
  Index particle;
  Index pin;      ///< the pinned particle
  Index group;    ///< of pins that limited springs connect
  double length;  ///< sum of rest lengths on the shortest path [m]
};

/// Largest number of tethers per particle: those to its nearest groups of pins.
inline constexpr int kMostTethers = 4;

/// From each free particle to the nearest pin of each group: the shortest paths along springs of these kinds that pass no other
/// pin (Dijkstra 1959). Ordered by particle, then by group.
[[nodiscard]] std::vector<Tether> find_tethers(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

/// Whether a body hangs taut between its pins: they do not move, form at least two groups, and all groups that share a tethered
/// particle are as far from each other at the start as springs within a limit of `max_stretch` reach. Requires tethers as
/// `find_tethers` orders them.
[[nodiscard]] bool are_pins_taut(const SpringNetwork& network, const Body& body, const std::vector<Tether>& tethers,
                                 double max_stretch);

/// The pair of pins that is farthest apart in proportion to the springs between them.
struct PinStretch {
  Index first = kNone;  ///< pinned particles; kNone: no two groups of pins share a tethered particle
  Index second = kNone;
  double length = 0.0;   ///< sum of rest lengths between them [m]
  double stretch = 0.0;  ///< (distance - length) / length [1], by which these springs are too long at least; may be negative
};

/// At these positions [m]. Requires tethers as `find_tethers` orders them.
[[nodiscard]] PinStretch largest_pin_stretch(const std::vector<Tether>& tethers, const Points& positions);

}  // namespace sprung
