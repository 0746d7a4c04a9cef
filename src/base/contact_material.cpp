#include "base/contact_material.h"

#include "base/format.h"
#include "base/problem_list.h"

namespace sprung {

void check_material(const std::string& key, const ContactMaterial& material, ProblemList& problems) {
  problems.require_not_negative(key + ".thickness", material.thickness, "give a gap in m");
  problems.require_not_negative(key + ".friction", material.friction, "use 0 for no friction");
  problems.require_not_negative(key + ".static_friction", material.static_friction, "use the value of friction");
  if (material.static_friction < material.friction) {
    problems.add(key + ".static_friction", format_number(material.static_friction),
                 "must not be less than friction, which is " + format_number(material.friction), "use the value of friction");
  }
  if (!(material.restitution >= 0.0 && material.restitution <= 1.0)) {
    problems.add(key + ".restitution", format_number(material.restitution), "must be in [0, 1]", "use 0 for no bounce");
  }
}

}  // namespace sprung
