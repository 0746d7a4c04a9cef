// Relaxation of separating half-spaces: final positions of particles that pins with different motions push together.
#pragma once

#include "collision/impact_zones/rotating_plane.h"
#include "collision/impact_zones/separation_tolerance.h"

#include <optional>
#include <vector>

namespace sprung {

/// A group that is drawn by pins with different motions has no common motion. Each particle then gets its own end. Rotating planes
/// make their pairs' separation a system of linear inequalities in these ends, which is relaxed one inequality at a time (Agmon
/// 1954).
class HalfSpaceRelaxation {
 public:
  /// The step begins at `before` [m], 3 x n. Fixed particles do not move. Keeps references to all arguments.
  HalfSpaceRelaxation(const Points& before, const ParticleMotions& motions, const SeparationTolerance& rule);

  /// A plane for the motion to `ends` [m]: with the pair's constant normal if that separates the sides, else a rotating one. Empty
  /// if the sides touch at the step's begin.
  [[nodiscard]] std::optional<RotatingPlane> plane(const ContactStencil& pair, const Points& ends) const;

  /// Whether the sides have such a plane and it does not separate them.
  [[nodiscard]] bool passes(const ContactStencil& pair, const Points& ends) const;

  /// Changes `ends` until no sides pass each other, for a limited number of sweeps: some may still pass. Returns the moved
  /// particles in any order.
  [[nodiscard]] std::vector<Index> move_apart(const std::vector<ContactStencil>& pairs, Points& ends) const;

 private:
  const Points& before_;
  const ParticleMotions& motions_;
  const SeparationTolerance& rule_;
};

}  // namespace sprung
