// The drag of a body in air.
#pragma once

namespace sprung {

/// Dry air at 20 C and 101,325 Pa, rounded.
inline constexpr double kAirDensity = 1.2;       ///< [kg/m^3]
inline constexpr double kAirViscosity = 1.5e-5;  ///< kinematic [m^2/s]

/// The drag of a body's own faces, or of its lines if it has no faces. SurfaceAirForce defines the force. Default: none, as in
/// vacuum. drag_in_air() returns the coefficients of a shape.
struct BodyDrag {
  double normal = 0.0;         ///< of faces: coefficient of the velocity across them [kg/m^3], >= 0
  double tangential = 0.0;     ///< of faces: coefficient of the velocity along them [kg/m^3], >= 0
  double line_diameter = 0.0;  ///< of lines, which are cylinders [m], >= 0

  [[nodiscard]] bool is_zero() const { return normal == 0.0 && tangential == 0.0 && line_diameter == 0.0; }
};

}  // namespace sprung
