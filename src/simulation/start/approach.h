// Moves a body from an intersection-free position towards the wanted one, as far as obstacles and other bodies permit.
#pragma once

#include "dynamics/contact/contact_projection.h"

namespace sprung {

class Approach {
 public:
  /// Only this body moves. Keeps a reference to the frame.
  Approach(const SpringNetwork& network, const ObstacleFrame& obstacles, Index body);

  /// Positions [m] after an approach from `free`, where the body intersects nothing, towards `wanted`. The body moves in strides of
  /// its element size. Particles that touch a surface slide along it; the others reach their wanted positions exactly.
  [[nodiscard]] Points run(const Points& free, const Points& wanted);

 private:
  /// Moves `x` to `advanced` under contact and truncation. Returns the largest displacement of a particle [m].
  double stride(Points& x, const Points& advanced);

  SpringNetwork network_;  ///< without friction, all other bodies pinned
  double length_ = 0.0;    ///< of a stride [m]; 0 for a body without segments and faces
  const ObstacleFrame& obstacles_;
  ContactProjection contacts_;
};

}  // namespace sprung
