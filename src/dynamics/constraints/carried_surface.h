// Keeps surfaces in the cells that carry them.
#pragma once

#include "dynamics/constraints/colouring.h"
#include "dynamics/constraints/constraint.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Keeps each particle of a carried surface (Body::carried) at its weighted sum of the corners of its cell. Surface particles have
/// a mass of their own, so contact pushes and stops them like those of cloths, and passes carry its pushes to the cells.
class CarriedSurface final : public Constraint {
 public:
  /// Keeps a reference to the network.
  explicit CarriedSurface(const SpringNetwork& network);

  double project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const override;

  /// A particle may be off by a thousandth of its cell.
  [[nodiscard]] double residual(const Points& positions) const override;

 private:
  struct Vertex {
    Index particle;
    CellPoint point;   ///< in the numbering of the network
    double tolerance;  ///< [m]
  };
  double project(const Vertex& vertex, Points& positions, const ImpulseRecorder& recorder) const;
  void record_pinned(const Vertex& vertex, const Vector3& multiplier, const ImpulseRecorder& recorder) const;

  const SpringNetwork& network_;
  std::vector<Vertex> vertices_;         ///< those in one cell follow each other
  std::vector<std::size_t> cell_begin_;  ///< in `vertices_`
  Colouring cells_;
};

}  // namespace sprung
