// The drag of the air on faces, four at a time. Internal to SurfaceAirForce.
#pragma once

#include "base/types.h"

#include <array>
#include <cstddef>

namespace sprung {

/// The rate, by 1 / step, up to which drag is not continued linearly. Leapfrog schemes then stay stable in steps up to 0.93 of the
/// largest stable one: with a damping rate of 1 / (4 dt) they need dt^2 l_K + 1 / 2 < 4.
inline constexpr double kRateOfStep = 0.25;

/// The drag across the faces of a body with a drag of its own is that of a plate in a steady flow at high speed. At low speed it is
/// proportional to the speed: c |u| (|u| + kSlow) [m/s]. Plates that swing by a small part of their size have a coefficient of up
/// to ten and more (Keulegan and Carpenter 1958; Graham 1980), as a hem of 0.3 m that swings by 5 mm.
inline constexpr double kSlow = 0.14;

/// A triangle or a segment. Its size is its area [m^2] or its length [m].
struct AirElement {
  std::array<Index, 3> ends{kNone, kNone, kNone};  ///< particles of the network; of a segment the first two
  int count = 0;                                   ///< of ends
  std::size_t law = 0;                             ///< number of the drag of its body
  double rest_size = 0.0;                          ///< > 0
  double rate_share = 0.0;                         ///< its rate [1/s] by its dF/du [kg/s]: see SurfaceAirForce
};

/// What the faces of a body feel. Points are 3 x n.
struct FaceAir {
  const double* positions;   ///< [m]
  const double* velocities;  ///< [m/s]
  const double* air;         ///< velocity of the air [m/s]; null: `mean` everywhere
  Vector3 mean;              ///< [m/s]
  double normal;             ///< see SurfaceDrag
  double tangential;
  bool quadratic;
  double slow;      ///< kSlow, or 0 [m/s]
  double expected;  ///< dF/du by area up to which quadratic drag is not continued linearly either [kg/(m^2 s)]
  double step;      ///< of an explicit scheme [s]; 0 for implicit ones
};

/// Writes a third of the force [N] on each of `count` triangles to `thirds`, 3 x count.
void find_face_forces(const AirElement* faces, Index count, const FaceAir& air, double* thirds);

}  // namespace sprung
