#include "network/problem_list.h"

namespace sprung {

void ProblemList::require_positive(const std::string& key, double value, const std::string& remedy) {
  if (value > 0.0 && std::isfinite(value)) return;
  add(key, format_number(value), "must be a finite number greater than 0", remedy);
}

void ProblemList::require_not_negative(const std::string& key, double value, const std::string& remedy) {
  if (value >= 0.0 && std::isfinite(value)) return;
  add(key, format_number(value), "must be a finite number not less than 0", remedy);
}

void ProblemList::require_count(const std::string& key, std::int64_t value, std::int64_t least) {
  if (value >= least) return;
  add(key, std::to_string(value), "must be at least " + std::to_string(least), "give more");
}

void ProblemList::require_affordable(const std::string& key, const std::string& value, double particles) {
  if (particles <= static_cast<double>(kMaxBodyParticles)) return;
  add(key, value,
      "makes " + format_number(particles) + " particles, more than the " + std::to_string(kMaxBodyParticles) + " of a body",
      "lower the resolution");
}

void ProblemList::require_materials(const SpringMaterials& materials) {
  const std::pair<const char*, const std::optional<SpringMaterial>&> kinds[] = {
      {"structural", materials.structural}, {"shear", materials.shear}, {"bend", materials.bend}};
  for (const auto& [name, material] : kinds) {
    if (!material) continue;
    const std::string key = std::string("springs.") + name;
    const bool modulus = material->measure == SpringMaterial::Measure::modulus;
    require_not_negative(key + (modulus ? ".modulus" : ".stiffness"), material->value,
                         "use 0 for springs that a stretch limit alone shall hold");
    require_not_negative(key + ".damping", material->damping, "use 0 for springs without damping");
  }
}

std::string entry_key(const std::string& key, std::size_t entry) {
  std::string text = key;
  text += '[';
  text += std::to_string(entry);
  text += ']';
  return text;
}

std::string vector_text(const Vector3& vector) {
  std::string text = "[";
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ", ";
    append_number(text, vector[axis]);
  }
  text += ']';
  return text;
}

std::string counts_text(std::span<const Index> counts) {
  std::string text = "[";
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (i > 0) text += ", ";
    text += std::to_string(counts[i]);
  }
  text += ']';
  return text;
}

}  // namespace sprung
