// What the springs that hold a body must hand on to its pins.
#pragma once

#include "dynamics/tethers/spring_graph.h"

namespace sprung {

/// How a body is held.
struct LoadCase {
  bool tethers;  ///< to pins that are taut
  bool shared;   ///< springs neither stretch nor shrink, and hold the shape: what many of them bear is not left to a few
};

/// Whether the limited springs of a surface are enough to hold its shape within itself: 2 n - 3 for n particles (Maxwell 1864).
[[nodiscard]] bool holds_shape(const Body& body, const SpringGraph& graph);

/// By how much a Gauss-Seidel pass leaves the most loaded limited spring of a body too long when each particle moves down by 1 m
/// before it, as a part of the spring's rest length [1/m]; 0 without limited springs. That is particles carried, times springs that
/// meet at a particle, over the rest length. With pins the free particles are shared evenly by the pinned ones that have limited
/// springs; with tethers one carries the springs of the longest strand that leads to it. Without pins the body may
/// hang over an obstacle by its middle: half the springs on the way between its farthest ends. `graph` is that of the limited
/// springs. Where the load is shared it falls with the number of springs that meet.
double largest_load(const SpringNetwork& network, const Body& body, const SpringGraph& graph, const LoadCase& load_case);

}  // namespace sprung
