// Edges at which the network's surfaces end or turn: contact of edges matters there, elsewhere corners and faces see to it.
#pragma once

#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

class FeatureEdges {
 public:
  /// All edges count as sharp. Keeps references to both.
  FeatureEdges(const CollisionSurface& surface, const SurfaceTopology& features);

  /// Looks at all edges again, with the particles at `positions` [m].
  void update(const Points& positions);

  /// Whether an edge does not belong to two triangles, or they turn by more than 45 degrees.
  [[nodiscard]] bool is_sharp(Index edge) const { return sharp_[static_cast<std::size_t>(edge)] != 0; }

 private:
  [[nodiscard]] bool turns(Index edge, const Points& positions) const;

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
  std::vector<char> sharp_;  ///< by edge
};

}  // namespace sprung
