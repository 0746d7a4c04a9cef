// The load that a body's springs pass on to its pins.
#pragma once

#include "dynamics/tethers/spring_graph.h"

namespace sprung {

/// How a body is suspended.
struct LoadCase {
  bool tethers;  ///< long range attachments to taut pins
  bool shared;   ///< springs neither stretch nor shrink and make the shape rigid, so that many springs share the load
};

/// Whether the limited springs of a surface make it rigid within itself: 2 n - 3 springs for n particles (Maxwell 1864).
[[nodiscard]] bool is_rigid(const Body& body, const SpringGraph& graph);

/// The relative excess of a body's most loaded limited spring after a Gauss-Seidel pass, per metre that each particle moved down
/// before it [1/m]; 0 without limited springs. It is the number of particles that the spring supports, times the number of springs
/// per particle, divided by the rest length. With pins, the pinned particles with limited springs share the free particles
/// equally; with tethers, each carries the springs of the longest strand that leads to it. Without pins the body may hang over an
/// obstacle by its middle: half the springs on the path between its farthest ends. A shared load decreases with the number of
/// springs per particle. `graph` is the graph of the limited springs.
double largest_load(const SpringNetwork& network, const Body& body, const SpringGraph& graph, const LoadCase& load_case);

}  // namespace sprung
