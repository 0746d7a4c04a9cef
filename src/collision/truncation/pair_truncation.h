// Where particles end that are in each other's way.
#pragma once

#include "collision/impact_zones/pair_separation.h"
#include "collision/truncation/vertex_truncation.h"

#include <vector>

namespace sprung {

/// Keeps the sides of pairs apart that would pass each other on their way.
class PairTruncation {
 public:
  /// Keeps references to all. `movable`, ascending, are the particles that the step may move.
  PairTruncation(ObstacleSafeRegions& regions, PairSeparation& pairs, const std::vector<Index>& movable);

  /// Changes `after` [m], 3 x n, which obstacles allow, to places that those allow and the sides of all pairs. Where there are none
  /// in the regions at hand, regions are made again where the step began and groups of particles go along with the obstacle that is
  /// in their way, as if they were a part of it: more and more particles, until all that are next to a group have a place. Before
  /// one obstacle that is rigid, or such that rest, they all have one, but for pins, and mostly before one that deforms; before
  /// others, if groups are small: in small parts of the interval. What finds none stays with its group: an obstacle can be left
  /// again, a knot in a cloth stays. Returns what became of the movable particles. Requires PairSeparation::begin_step() or
  /// begin_part() with the same `before`.
  Outcomes place(const Points& before, Points& after);

 private:
  Outcomes place_held(const Points& before, Points& after);
  [[nodiscard]] Outcome place_held(Index particle, const Vector3& before, const Vector3& target, Points& after) const;
  [[nodiscard]] Outcomes of_movable(const Outcomes& of_held) const;
  [[nodiscard]] static std::vector<Index> infeasible(const std::vector<Index>& particles, const Outcomes& outcomes);
  /// Held particles that obstacles leave none; not those that pins drag.
  [[nodiscard]] std::vector<Index> without_place(const Outcomes& outcomes) const;
  void place_among_obstacles(const Way& way, Points& after);
  /// Whether any held particle is an anchor now that was none, or begins to move.
  bool anchor_infeasible(const Outcomes& outcomes, const Points& before, const Points& after);

  void accept_carried(const Points& after, Outcomes& outcomes);
  void look_at_misplaced(const Points& after, Outcomes& outcomes);
  /// The particle's anchor, or the first of one that comes after it.
  [[nodiscard]] std::vector<KinematicAnchor>::iterator find_anchor(Index particle);

  ObstacleSafeRegions& regions_;
  PairSeparation& pairs_;
  const std::vector<Index>& movable_;
  std::vector<Index> held_;
  std::vector<Index> misplaced_;  ///< by place_among_obstacles(), ascending
  ParticleDisplacements carriers_;
};

}  // namespace sprung
