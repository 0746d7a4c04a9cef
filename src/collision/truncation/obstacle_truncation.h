// Where particles end that obstacles do not let go where they want, all of them: the last word before obstacles.
#pragma once

#include "collision/obstacles/environment.h"
#include "collision/truncation/time_subdivision.h"
#include "collision/truncation/truncation_result.h"

#include <vector>

namespace sprung {

class ObstacleTruncation {
 public:
  /// Keeps references to all.
  ObstacleTruncation(Environment& environment, const CollisionSurface& surface, ObstacleSafeRegions& regions);

  /// Places all particles in `after` [m], 3 x n: where their way leads, or as near to there as regions allow that are made again
  /// where they stop one short. Where there are none obstacles carry what is in their way, then all go in parts of the interval.
  TruncationResult place_all(const Way& way, Points& after);

  /// Particles that found no place when all were placed last, or of whose elements an obstacle crosses one; ascending.
  [[nodiscard]] const std::vector<Index>& infeasible() const { return infeasible_; }

  /// Particles that did not arrive at once when all were placed last.
  [[nodiscard]] const std::vector<Index>& held_back() const { return held_back_; }

  /// Places all of these movable particles in a part of the environment's interval, which may begin anywhere.
  ClippedSubstep place_part(std::vector<Index>& particles, const Way& part, Points& after);

  /// Looks where pins are now; squeezes those of the particles of whose elements an obstacle crosses one that it did not cross
  /// where the way began. False where regions did not hold pins: then that is known for this place alone.
  bool look_at_pins(const std::vector<Index>& particles, const Points& after, Outcomes& outcomes);

  /// Whether obstacles or pins move: else there is a place where the way begins.
  [[nodiscard]] bool closes_in(const Way& way) const;

  /// Particles that are not pinned and whose ways are finite, ascending.
  [[nodiscard]] std::vector<Index> all_movable(const Way& way) const;

  [[nodiscard]] const std::vector<Index>& pinned() const { return pinned_; }  ///< ascending

 private:
  [[nodiscard]] std::vector<Index> movable(std::vector<Index> particles, const Way& way) const;
  /// Particles are ascending; those that may be held back too are added.
  Outcomes clip_with_fresh_regions(std::vector<Index>& particles, const Way& way, Points& after);
  ClippedSubstep place_anew(std::vector<Index>& particles, const Way& way, Points& after);
  ClippedSubstep place_ahead(std::vector<Index>& particles, const Way& part, const Points& goals, Points& after);

  void note_crossed();
  /// Pins that their regions do not hold there.
  [[nodiscard]] std::vector<Index> leaving_pins(const Points& positions) const;

  TruncationResult lead_on(const std::vector<Index>& particles, const Outcomes& outcomes, const Way& way, Points& after);
  /// Leaves in `stopped` those that may come farther yet; returns how many arrived.
  Index go_on(std::vector<Index>& stopped, const Points& target, Points& after);
  [[nodiscard]] bool can_go_on(Index particle, const Way& way, const Points& now) const;
  void list_infeasible(const std::vector<Index>& particles, const Outcomes& outcomes);

  Environment& environment_;
  const ObstacleSet& set_;
  const CollisionSurface& surface_;
  ObstacleSafeRegions& regions_;
  std::vector<Index> pinned_;
  std::vector<char> crossed_before_;  ///< by particle, where the way begins; empty where none is
  std::vector<Index> held_back_;
  std::vector<Index> infeasible_;
};

}  // namespace sprung
