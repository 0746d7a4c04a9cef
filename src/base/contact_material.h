// What bodies and obstacles both carry into a contact.
#pragma once

#include <string>

namespace sprung {

class ProblemList;

/// How a body or an obstacle meets others. A pair keeps the gap `thickness + thickness`, rubs with the geometric means of the
/// frictions and bounces with the larger restitution.
struct ContactMaterial {
  double thickness = 0.0;        ///< [m], >= 0
  double friction = 0.0;         ///< kinetic coefficient, >= 0
  double static_friction = 0.0;  ///< >= friction
  double restitution = 0.0;      ///< in [0, 1]
};

/// Adds the rules above that the material breaks; `key` is the start of the keys, such as `bodies.rope`.
void check_material(const std::string& key, const ContactMaterial& material, ProblemList& problems);

}  // namespace sprung
