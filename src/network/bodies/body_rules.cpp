#include "network/bodies/body_rules.h"

#include "base/format.h"

#include <optional>
#include <utility>

namespace sprung {

void require_affordable(const std::string& key, const std::string& value, double particles, ProblemList& problems) {
  if (particles <= static_cast<double>(kMaxBodyParticles)) return;
  problems.add(key, value,
               "makes " + format_number(particles) + " particles, but a body may have at most " + std::to_string(kMaxBodyParticles),
               "lower the resolution");
}

void refuse_angle_bends(const SpringMaterials& materials, const std::string& body, ProblemList& problems) {
  if (!materials.bend || materials.bend_model != SpringMaterials::BendModel::angle) return;
  problems.add("springs.bend.model", "\"angle\"", "is only for ropes and cloths: " + body + " resists bending by springs",
               "use \"spring\", or use a cloth");
}

void require_materials(const SpringMaterials& materials, ProblemList& problems) {
  const std::pair<const char*, const std::optional<SpringMaterial>&> kinds[] = {
      {"structural", materials.structural}, {"shear", materials.shear}, {"bend", materials.bend}};
  for (const auto& [name, material] : kinds) {
    if (!material) continue;
    const std::string key = std::string("springs.") + name;
    const bool modulus = material->measure == SpringMaterial::Measure::modulus;
    problems.require_not_negative(key + (modulus ? ".modulus" : ".stiffness"), material->value,
                                  "use 0 for springs that only a stretch limit constrains");
    problems.require_not_negative(key + ".damping", material->damping, "use 0 for springs without damping");
    problems.require_not_negative(key + ".damping_time", material->damping_time, "use 0 for springs without damping");
    if (!material->damping_ratio) continue;
    problems.require_not_negative(key + ".damping_ratio", *material->damping_ratio, "use 0 for springs without damping");
    if (material->damping != 0.0 || material->damping_time != 0.0)
      problems.add(key + ".damping_ratio", format_number(*material->damping_ratio),
                   "must not be given together with damping or damping_time", "remove one of them");
    if (material->value == 0.0)
      problems.add(key + ".damping_ratio", format_number(*material->damping_ratio),
                   "needs springs with stiffness, because it is a fraction of their critical damping", "give damping instead");
  }
}

}  // namespace sprung
