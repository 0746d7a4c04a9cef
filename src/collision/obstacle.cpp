#include "collision/obstacle.h"

namespace sprung {

bool Obstacle::changes() const {
  const auto* deforming = std::get_if<SequenceGeometry>(&geometry);
  return motion.moves() || (deforming != nullptr && deforming->sequence->deforms());
}

}  // namespace sprung
