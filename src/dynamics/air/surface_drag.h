// The drag of the air on faces.
#pragma once

namespace sprung {

/// Coefficients of SurfaceAirForce: by area and speed [kg/(m^2 s)], or, if quadratic, by area and squared speed [kg/m^3], as half
/// the density of the air times a drag coefficient.
struct SurfaceDrag {
  double normal = 0.0;      ///< of the velocity across a face, >= 0
  double tangential = 0.0;  ///< of the velocity along it, >= 0
  bool quadratic = false;

  [[nodiscard]] bool is_zero() const { return normal == 0.0 && tangential == 0.0; }
};

}  // namespace sprung
