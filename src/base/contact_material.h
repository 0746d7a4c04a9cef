// Contact properties of bodies and obstacles.
#pragma once

#include <string>

namespace sprung {

class ProblemList;

/// The contact properties of a body or an obstacle. A contact with an obstacle has the sum of the thicknesses as its gap, a contact
/// between bodies their mean. It has the geometric means of the friction coefficients and the larger restitution.
struct ContactMaterial {
  double thickness = 0.0;             ///< [m], >= 0
  double friction = 0.0;              ///< kinetic coefficient, >= 0
  double static_friction = friction;  ///< >= friction; by default that with which the material is initialized
  double restitution = 0.0;           ///< in [0, 1]

  bool operator==(const ContactMaterial&) const = default;
};

/// Adds a problem for each of these rules that the material breaks. `key` is the prefix of the keys, such as `bodies.rope`.
void check_material(const std::string& key, const ContactMaterial& material, ProblemList& problems);

}  // namespace sprung
