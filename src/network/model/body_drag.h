// The drag of the air on a body.
#pragma once

namespace sprung {

/// Dry air at 20 C and 101,325 Pa, rounded.
inline constexpr double kAirDensity = 1.2;       ///< [kg/m^3]
inline constexpr double kAirViscosity = 1.5e-5;  ///< kinematic [m^2/s]

/// The drag of a body's faces, or of the lines of a body without faces: quadratic, and linear at low speed, as SurfaceAirForce has
/// it. Default: none, as in vacuum. drag_in_air() has the coefficients of a shape.
struct BodyDrag {
  double normal = 0.0;         ///< of faces, by area and squared speed across them [kg/m^3], >= 0
  double tangential = 0.0;     ///< of faces, by area and squared speed along them [kg/m^3], >= 0
  double line_diameter = 0.0;  ///< of lines, which are cylinders [m], >= 0

  [[nodiscard]] bool is_zero() const { return normal == 0.0 && tangential == 0.0 && line_diameter == 0.0; }
};

}  // namespace sprung
