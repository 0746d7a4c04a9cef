// Clips particles before other elements of the network, and again before obstacles.
#pragma once

#include "collision/impact_zones/pair_separation.h"
#include "collision/truncation/vertex_truncation.h"

#include <vector>

namespace sprung {

/// Separates the sides of pairs that would cross on their paths. Lives for one step or substep.
class PairTruncation {
 public:
  /// Keeps references to all. `movable`, ascending, are the particles that the step may move.
  PairTruncation(const ObstacleFrame& obstacles, ObstacleSafeRegions& regions, PairSeparation& pairs,
                 const std::vector<Index>& movable);

  /// Clips `after` [m], 3 x n, which is admissible before obstacles, to positions that are admissible before obstacles and for all
  /// pairs. Returns the outcomes of the movable particles. Requires PairSeparation::begin_step() or begin_substep() with the same
  /// `before`.
  ///
  /// Where the two exclude each other, regions are renewed at `before`, and the infeasible particles become blocked vertices: their
  /// motion groups move with the obstacle that blocks them. This repeats until no blocked vertex is new. It finds an admissible
  /// position for every particle that no pin drives if the obstacles are at rest, or a single rigid one moves; mostly if a single
  /// one deforms; with several moving obstacles if groups are small, that is in small substeps. A particle without one stays with
  /// its group, since a particle can leave an obstacle again, but a knot in a cloth stays.
  Outcomes clip(const Points& before, Points& after);

 private:
  Outcomes clip_constrained(const Points& before, Points& after);
  void clip_before_obstacles(const StepPaths& paths, Points& after);
  /// Makes infeasible particles blocked vertices. Returns whether any is new, or a resting one moves now.
  bool block_infeasible(const Outcomes& outcomes, const Points& before, const Points& after);
  void accept_moved(const Points& after, Outcomes& outcomes);
  void check_unplaced(const Points& after, Outcomes& outcomes);

  [[nodiscard]] Outcomes of_movable(const Outcomes& of_constrained) const;
  /// Constrained particles that obstacles block; without those that pins pull through other elements.
  [[nodiscard]] std::vector<Index> blocked_by_obstacles(const Outcomes& outcomes) const;
  /// The particle's blocked vertex or, if it has none, the first one after it.
  [[nodiscard]] std::vector<BlockedVertex>::iterator find_blocked(Index particle);

  const ObstacleFrame& obstacles_;
  ObstacleSafeRegions& regions_;
  PairSeparation& pairs_;
  const std::vector<Index>& movable_;
  std::vector<Index> constrained_;  ///< particles of pairs that would cross, ascending
  std::vector<Index> unplaced_;     ///< infeasible before obstacles alone, ascending
  ParticleDisplacements displacements_;
};

}  // namespace sprung
