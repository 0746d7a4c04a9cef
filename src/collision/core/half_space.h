// Half-spaces, and the projection of a point onto their intersection.
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"

#include <optional>
#include <span>
#include <vector>

namespace sprung {

/// normal . x >= offset; unit normal.
struct HalfSpace {
  Vector3 normal = Vector3::Zero();
  double offset = 0.0;  ///< [m]
};

template <Same<HalfSpace> S, class Visit>
void visit_members(S& h, const Visit& visit) {
  visit(h.normal, h.offset);
}

/// Whether p is in all half-spaces, apart from the rounding of coordinates as large as those of p and the offsets.
[[nodiscard]] bool is_feasible(std::span<const HalfSpace> half_spaces, const Vector3& p);

/// A point inside all half-spaces, near `target`. It is projected in turn onto each half-space that it violates (Agmon 1954;
/// Motzkin and Schoenberg 1954). If this does not converge in a few rounds, or ends farther from the target than the first of the
/// `safe` points that is feasible, the result is on a straight line from that safe point: as far towards the projection or the
/// target as the half-spaces permit. Empty if the projection does not converge and no safe point is feasible.
[[nodiscard]] std::optional<Vector3> feasible_point(std::span<const HalfSpace> half_spaces, const Vector3& target,
                                                    std::span<const Vector3> safe);

}  // namespace sprung
