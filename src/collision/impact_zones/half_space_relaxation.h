// Where particles end that give way to each other and to pins, each on its own.
#pragma once

#include "collision/impact_zones/rotating_plane.h"
#include "collision/impact_zones/separation_tolerance.h"

#include <optional>
#include <vector>

namespace sprung {

/// What several pins draw together, each its own way, no single motion takes along. Planes that turn leave it its own: what they
/// ask of the particles' ends are linear inequalities, which are met one after the other, again and again (Agmon 1954).
class HalfSpaceRelaxation {
 public:
  /// The step begins at `before` [m], 3 x n; pinned particles (not 0) end where they do. Keeps references to all.
  HalfSpaceRelaxation(const Points& before, const std::vector<char>& pinned, const SeparationTolerance& rule);

  /// A plane for the way to `ends` [m]: with the pair's normal if that does, else one that turns; none if the sides touch where the
  /// step begins.
  [[nodiscard]] std::optional<RotatingPlane> plane(const ContactStencil& pair, const Points& ends) const;

  /// Whether there is one, and it does not keep the sides apart.
  [[nodiscard]] bool passes(const ContactStencil& pair, const Points& ends) const;

  /// Moves the ends of sides apart that would pass each other, and of those that are then in the way. Returns which were moved, in
  /// any order; of some, sides may still pass.
  [[nodiscard]] std::vector<Index> move_apart(const std::vector<ContactStencil>& pairs, Points& ends) const;

 private:
  const Points& before_;
  const std::vector<char>& pinned_;
  const SeparationTolerance& rule_;
};

}  // namespace sprung
