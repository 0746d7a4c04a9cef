// A rod as solvers of constraints see it.
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"

#include <array>
#include <cstddef>
#include <span>

namespace sprung {

/// The difference of the ends, sum_k weights[k] x[particles[k]] - anchor, has the length `length`.
struct RodRow {
  std::array<Index, 4> particles{};
  std::array<double, 4> weights{};   ///< 1 for the first end, negative for the second
  std::size_t count = 0;             ///< of particles
  Vector3 anchor = Vector3::Zero();  ///< the second end on an obstacle at the end of the step [m]; else 0
  double length = 0.0;               ///< at the end of the step [m]
  double tolerance = 0.0;            ///< permitted error of the length [m]

  [[nodiscard]] std::span<const Index> ends() const { return {particles.data(), count}; }

  /// The weighted sum of the columns of `points`, 3 x n, that `column(k)` names.
  template <class Column>
  [[nodiscard]] Vector3 difference(const Points& points, const Column& column) const {
    Vector3 sum = -anchor;
    for (std::size_t k = 0; k < count; ++k) sum += weights[k] * points.col(column(k));
    return sum;
  }
};

template <Same<RodRow> S, class Visit>
void visit_members(S& r, const Visit& visit) {
  visit(r.particles, r.weights, r.count, r.anchor, r.length, r.tolerance);
  if (r.count > r.particles.size()) throw BytesError();
}

}  // namespace sprung
