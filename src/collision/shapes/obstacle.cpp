#include "collision/shapes/obstacle.h"

namespace sprung {

bool Obstacle::deforms() const {
  const auto* mesh = std::get_if<SequenceGeometry>(&geometry);
  return mesh != nullptr && mesh->sequence->deforms();
}

}  // namespace sprung
