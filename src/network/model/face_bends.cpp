#include "network/model/face_bends.h"

#include <algorithm>

namespace sprung {

BendStencil stencil_of(const FaceBends& bends, const Hinges& hinges, Index element) {
  BendStencil stencil;
  std::size_t count = 0;
  for (std::size_t side = 0; side < 3; ++side) {
    const Index hinge = bends.hinges[element][side];
    if (hinge == kNone) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const Index particle = hinges.particles[hinge][i];
      const auto* const end = stencil.particles.begin() + count;
      const auto at = static_cast<std::size_t>(std::find(stencil.particles.cbegin(), end, particle) - stencil.particles.cbegin());
      if (at == count) stencil.particles[count++] = particle;
      stencil.of_hinges[side][i] = at;
    }
  }
  std::fill(stencil.particles.begin() + count, stencil.particles.end(), stencil.particles[0]);
  return stencil;
}

std::array<std::array<double, 6>, 3> weights_of(const FaceBends& bends, const Hinges& hinges, Index element) {
  const BendStencil stencil = stencil_of(bends, hinges, element);
  std::array<std::array<double, 6>, 3> weights{};
  for (std::size_t side = 0; side < 3; ++side) {
    const Index hinge = bends.hinges[element][side];
    if (hinge == kNone) continue;
    for (std::size_t row = 0; row < 3; ++row) {
      const double factor = bends.curvature[element](static_cast<Index>(row), static_cast<Index>(side));
      for (std::size_t i = 0; i < 4; ++i) weights[row][stencil.of_hinges[side][i]] += factor * hinges.weights[hinge][i];
    }
  }
  return weights;
}

}  // namespace sprung
