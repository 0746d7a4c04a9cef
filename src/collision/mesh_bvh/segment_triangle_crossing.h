// Whether a path crosses a triangle, exactly.
#pragma once

#include "base/types.h"

#include <optional>

namespace sprung {

/// Which crossings of a path count: from either side, or only those from the front of a triangle, where (v - u) x (w - u) points
/// to.
enum class CrossingSides : std::uint8_t { both, front };

/// The fraction in [0, 1] at which the path from a to b crosses the closed triangle (u, v, w), or nothing. Decided by exact signs
/// of volumes. A point on an edge or a vertex belongs to every triangle with that edge or vertex, so a path cannot pass between
/// neighbours. A path that ends on the triangle crosses it. A path that begins on it crosses with `front` if it ends behind it,
/// and never with `both`. A path within the triangle's plane does not cross it, and no path crosses a triangle without area.
[[nodiscard]] std::optional<double> crossing_fraction(const Vector3& a, const Vector3& b, const Vector3& u, const Vector3& v,
                                                      const Vector3& w, CrossingSides sides);

}  // namespace sprung
