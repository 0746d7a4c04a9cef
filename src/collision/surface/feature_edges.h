// Feature edges: boundaries and creases of the network's surfaces. Only they need edge-edge contacts; elsewhere vertex-face
// contacts are enough.
#pragma once

#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

class FeatureEdges {
 public:
  /// All edges are sharp at first. Keeps references to both arguments.
  FeatureEdges(const CollisionSurface& surface, const SurfaceTopology& features);

  /// Classifies all edges for the particles at `positions` [m].
  void update(const Points& positions);

  /// Whether the edge does not belong to exactly two triangles, or their normals differ by more than 45 degrees.
  [[nodiscard]] bool is_sharp(Index edge) const { return sharp_[static_cast<std::size_t>(edge)] != 0; }

 private:
  [[nodiscard]] bool turns(Index edge, const Points& positions) const;

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
  std::vector<char> sharp_;  ///< by edge
};

}  // namespace sprung
