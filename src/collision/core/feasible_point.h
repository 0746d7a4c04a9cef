// Where a particle may go when it may not go where it wants.
#pragma once

#include "collision/core/half_space.h"

#include <optional>
#include <span>
#include <vector>

namespace sprung {

/// Whether p is in all half-spaces, to within the rounding of positions as large as p and the offsets.
[[nodiscard]] bool is_feasible(std::span<const HalfSpace> half_spaces, const Vector3& p);

/// A point of what the half-spaces have in common, near `target`: found by projecting it onto each that it violates, in turn
/// (Agmon 1954; Motzkin and Schoenberg 1954). Where a few rounds do not suffice, or lead farther from the target than the first of
/// the `safe` points that is feasible, it is as far as one can go from that point towards it. Nothing if neither finds one.
[[nodiscard]] std::optional<Vector3> feasible_point(std::span<const HalfSpace> half_spaces, const Vector3& target,
                                                    std::span<const Vector3> safe);

}  // namespace sprung
