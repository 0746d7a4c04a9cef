// Short edges of a mesh: softer springs and heavier particles, so that a few elements do not bound the step of a whole scene.
#pragma once

#include "network/bodies/body_shape.h"

#include <optional>
#include <string>

namespace sprung {

/// What adjust_for_step() changed.
struct StepAdjustment {
  std::string body{};              ///< its name
  Index softened = 0;              ///< number of springs, angle bends and face bends that are softer
  double least_factor = 1.0;       ///< smallest factor of their stiffness and damping
  Index heavier = 0;               ///< number of particles that are heavier
  double added_mass = 0.0;         ///< in total [kg]
  double mass = 0.0;               ///< of the body before [kg]
  Vector3 from = Vector3::Zero();  ///< ends of the edge that needed the smallest step [m]
  Vector3 to = Vector3::Zero();
  double length = 0.0;  ///< of that edge at rest [m]
};

/// Bodies of fewer particles are left as they are.
inline constexpr Index kLeastAdjusted = 200;

/// Two measures, of a body with masses. First, springs and bends that alone would need a step below half of what 99 in 100
/// need become softer, with their damping, until they need that. Second, particles on which all elements together act so fast that
/// they need a step below half of what particles of 99 % of the mass need become heavier (selective mass scaling, Olovsson,
/// Simonsson and Unosson 2005), by at most `mass_share` of the body's mass in total: less of each if that does not suffice. None if
/// nothing changed.
[[nodiscard]] std::optional<StepAdjustment> adjust_for_step(BodyShape& shape, double mass_share);

/// For users: what changed, and where.
[[nodiscard]] std::string describe(const StepAdjustment& adjustment);

}  // namespace sprung
