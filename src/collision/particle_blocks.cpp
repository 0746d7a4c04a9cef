#include "collision/particle_blocks.h"

namespace sprung {

Box3 finite_bounds(const Points& positions, Index begin, Index end) {
  Box3 box;
  for (Index i = begin; i < end; ++i) {
    if (positions.col(i).allFinite()) box.extend(positions.col(i));
  }
  return box;
}

Box3 grown(const Box3& box, double distance) {
  if (box.isEmpty()) return box;
  const double rounding = 1e-9 * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const Vector3 margin = Vector3::Constant(distance + rounding);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace sprung
