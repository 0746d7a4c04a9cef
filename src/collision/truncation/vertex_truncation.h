// Clips the displacement of single particles to the half-spaces around them, and subdivides the interval where that fails.
#pragma once

#include "collision/impact_zones/pair_separation.h"
#include "collision/obstacle_regions/obstacle_motion.h"

#include <functional>
#include <vector>

namespace sprung {

/// The result of clipping one particle.
enum class Outcome : char {
  free,       ///< it reached its target
  stopped,    ///< it is at another admissible position
  infeasible  ///< no admissible position was found
};
using Outcomes = std::vector<Outcome>;

[[nodiscard]] Index count(const Outcomes& outcomes, Outcome wanted);

/// The particles with this outcome, in their order.
[[nodiscard]] std::vector<Index> particles_with(Outcome wanted, const std::vector<Index>& particles, const Outcomes& outcomes);

/// Sets those of `outcomes` to infeasible that are infeasible in `before`.
void keep_infeasible(const Outcomes& before, Outcomes& outcomes);

/// Clips positions to half-spaces: to the safe regions before obstacles, and to the division planes between elements. No other
/// class does so.
class VertexTruncation {
 public:
  /// Clips to the safe regions alone, or to `pairs` too: then only particles that PairSeparation::constrain() returned. Keeps
  /// references.
  explicit VertexTruncation(const ObstacleSafeRegions& regions, const PairSeparation* pairs = nullptr);

  /// Moves each of these particles, independently of the others, to its target or to a nearby admissible position: sets its column
  /// of `positions` [m], 3 x n. A particle without an admissible position moves with an obstacle near it, if one moves, or to its
  /// safe position among the pairs.
  Outcomes clip(const std::vector<Index>& particles, const StepPaths& paths, Points& positions) const;

 private:
  [[nodiscard]] Outcome clip(Index particle, const StepPaths& paths, Points& positions) const;
  [[nodiscard]] bool allows(const ObstacleFrame& obstacles, Index particle, const Vector3& position) const;
  /// Positions that are admissible unless surfaces close in on the particle. The first is the fallback.
  [[nodiscard]] std::vector<Vector3> safe_positions(Index particle, const StepPaths& paths) const;
  [[nodiscard]] Vector3 within_sphere(Index particle, const Vector3& position) const;

  const ObstacleSafeRegions& regions_;
  const PairSeparation* pairs_;
};

/// The result of clipping all particles in a substep.
struct ClippedSubstep {
  Outcomes outcomes;
  bool path_checked =
      true;  ///< no element crosses anything along the path; false if a pin left its regions: then known for the end only
};

/// Clips particles to positions in `after` [m], 3 x n, in the substep of the paths. Returns the outcomes of the same particles each
/// time.
using ClipSubstep = std::function<ClippedSubstep(const StepPaths& paths, Points& after)>;

/// Clips particles in substeps of the paths' interval. Surfaces that close in on each other may leave no admissible
/// position along a straight path although there is one beside it. Shorter substeps find it, because planes are renewed before the
/// surfaces touch. Substeps are halved, down to 1/64 of the interval, while `clip` reports infeasible particles or an unchecked
/// path. Returns the outcomes of the last substep, but infeasible for particles that were infeasible in any.
Outcomes clip_in_substeps(const StepPaths& paths, Points& after, const ClipSubstep& clip);

}  // namespace sprung
