// The impulses with which links gave a component the displacement of a global solve.
#pragma once

#include "dynamics/numerics/block_cholesky.h"
#include "dynamics/state/recorded_impulses.h"
#include "dynamics/stretch_newton/stretch_component.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <memory>

namespace sprung {

/// A solver moves the free points of a component from y to x, which gives them the momenta m (x - y); links alone can do so. In a
/// chain or tree with one pin each link carries the momenta of all that hangs on it. Elsewhere impulses are those of an elastic
/// network at rest under these loads, whose links at their limit are a thousand times stiffer than others, and hardly stiff across
/// their directions. Their sum is exact in each case, and so are their moments up to a millionth; where pins strain a body between
/// them, no momentum tells by how much.
class ComponentImpulses {
 public:
  ComponentImpulses(StretchComponent component, const StretchLimitSettings& settings);

  /// Records what links gave to pins and springs when a solve moved free particles from `target` to `positions` [m], 3 x particles.
  void record(const Points& target, const Points& positions, const ImpulseRecorder& recorder);

 private:
  [[nodiscard]] Points along_tree(Points momenta) const;
  [[nodiscard]] Points as_elastic(const Points& momenta, const Points& positions);
  [[nodiscard]] Vector3 position(Index point, const Points& positions) const { return positions.col(component_.points[point]); }

  StretchComponent component_;
  StretchLimitSettings settings_;
  bool hangs_on_one_;  ///< each free point is the first of one link: its momentum has one way to go
  BlockMatrix matrix_;
  std::unique_ptr<BlockCholesky<double>> factor_;  ///< made when it is needed
};

}  // namespace sprung
