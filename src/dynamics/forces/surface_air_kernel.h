// The drag of the air on faces, four at a time. Internal to SurfaceAirForce.
#pragma once

#include "base/types.h"

#include <array>
#include <cstddef>

namespace sprung {

/// The damping rate, in units of 1 / step, beyond which quadratic drag becomes linear. Leapfrog schemes with a rate of 1 / (4 dt)
/// need dt^2 l_K + 1 / 2 < 4: they are stable in steps up to sqrt(7/8) = 0.93 of the largest stable one without drag.
inline constexpr double kRateOfStep = 0.25;

/// [m/s]. Across its own faces, a body has the drag c |u| (|u| + kLowSpeed): that of a plate in a steady flow at high speed, and
/// linear at low speed. Plates that swing by a small part A of their size l have a higher coefficient than in a steady flow
/// (Keulegan and Carpenter 1958), 8 (2 pi A / l)^(-1/3) by Graham 1980: 20 for a hem of 0.1 m that swings by 1 mm, with 12 mm/s.
/// Chosen: it has 1.17 (1 + 0.14 / 0.012) = 15 here, and less than Graham's at larger amplitudes.
inline constexpr double kLowSpeed = 0.14;

/// A triangle or a segment. Its size is its area [m^2] or its length [m].
struct AirElement {
  std::array<Index, 3> ends{kNone, kNone, kNone};  ///< particles of the network; of a segment the first two
  int count = 0;                                   ///< of ends
  std::size_t law = 0;                             ///< number of the drag of its body
  double rest_size = 0.0;                          ///< > 0
  double rate_share = 0.0;                         ///< damping rate [1/s] per dF/du [kg/s], hence [1/kg]: see SurfaceAirForce
};

/// The drag of a body's faces, the motion of its particles and the air. Points are 3 x n.
struct FaceAir {
  const double* positions;   ///< [m]
  const double* velocities;  ///< [m/s]
  const double* air;         ///< velocity of the air [m/s]; null: `mean` everywhere
  Vector3 mean;              ///< [m/s]
  double normal;             ///< see SurfaceDrag
  double tangential;         ///< see SurfaceDrag
  bool quadratic;            ///< see SurfaceDrag
  double low_speed;          ///< kLowSpeed for the drag of a body, 0 for that of the settings [m/s]
  double expected;           ///< dF/du by area up to which drag stays quadratic whatever the step [kg/(m^2 s)]
  double step;               ///< of an explicit scheme [s]; 0 for implicit ones
};

/// Writes a third of the force [N] on each of `count` triangles to `thirds`, 3 x count.
void find_face_forces(const AirElement* faces, Index count, const FaceAir& air, double* thirds);

}  // namespace sprung
