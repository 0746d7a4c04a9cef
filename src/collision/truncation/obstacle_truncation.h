// Clips all particles before obstacles.
#pragma once

#include "collision/truncation/truncation_result.h"
#include "collision/truncation/vertex_truncation.h"

#include <vector>

namespace sprung {

class ObstacleTruncation {
 public:
  /// Keeps references to both.
  ObstacleTruncation(const CollisionSurface& surface, ObstacleSafeRegions& regions);

  /// Reads again which particles of the surface are fixed.
  void find_fixed();

  /// Sets `after` [m], 3 x n, to the targets of the paths, or to nearby admissible positions. Regions that stop a particle are
  /// renewed so that it can continue. Infeasible particles move with the obstacles; if that is not enough, the interval is
  /// subdivided.
  TruncationResult clip_all(const StepPaths& paths, Points& after);

  /// Particles without an admissible position in the last clip_all(), and corners of elements that an obstacle crosses; ascending.
  [[nodiscard]] const std::vector<Index>& infeasible() const { return infeasible_; }

  /// Particles that were stopped at first in the last clip_all(), ascending, even if they reached their targets in later rounds.
  [[nodiscard]] const std::vector<Index>& stopped() const { return stopped_; }

  /// Clips these movable particles in a substep.
  ClippedSubstep clip_substep(std::vector<Index>& particles, const StepPaths& paths, Points& after);

  /// Renews the regions of pins that left theirs by `after` [m], 3 x n, at the end of the interval. Makes a particle infeasible if
  /// an obstacle crosses one of its elements and crossed none of them at the start of the path. Returns whether no pin left its
  /// regions; otherwise crossings are known for `after` only.
  bool check_pins(const ObstacleFrame& obstacles, const std::vector<Index>& particles, const Points& after, Outcomes& outcomes);

  /// Whether obstacles or pins move. If none does, the start of a path is an admissible position.
  [[nodiscard]] bool is_kinematic(const StepPaths& paths) const;

  /// Particles that are not fixed and whose paths are finite, ascending.
  [[nodiscard]] std::vector<Index> all_movable(const StepPaths& paths) const;

 private:
  [[nodiscard]] std::vector<Index> movable(std::vector<Index> particles, const StepPaths& paths) const;
  /// Clips, and again with renewed regions if any particle was stopped. Adds particles, ascending, that the new regions may stop.
  Outcomes clip_with_fresh_regions(std::vector<Index>& particles, const StepPaths& paths, Points& after);
  ClippedSubstep clip_anew(std::vector<Index>& particles, const StepPaths& paths, Points& after);
  ClippedSubstep clip_ahead(std::vector<Index>& particles, const StepPaths& paths, const Points& goals, Points& after);

  void record_crossed();
  /// Pins that are outside of their regions at these positions.
  [[nodiscard]] std::vector<Index> leaving_pins(const ObstacleFrame& obstacles, const Points& positions) const;

  TruncationResult continue_stopped(const std::vector<Index>& particles, const Outcomes& outcomes, const StepPaths& paths,
                                    Points& after);
  /// Keeps in `stopped` the particles that may still move on. Returns how many reached their target.
  Index continue_once(std::vector<Index>& stopped, const StepPaths& paths, Points& after);
  [[nodiscard]] bool can_continue(Index particle, const StepPaths& paths, const Points& now) const;
  void list_infeasible(const std::vector<Index>& particles, const Outcomes& outcomes);

  const CollisionSurface& surface_;
  ObstacleSafeRegions& regions_;
  VertexTruncation truncation_;
  std::vector<Index> fixed_;
  std::vector<char> crossed_before_;  ///< by particle: 1 if an element is crossed at the start of the path; empty if none is
  std::vector<Index> stopped_;
  std::vector<Index> infeasible_;
};

}  // namespace sprung
