#include "scene/building/strength_scatter.h"

#include "base/random.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace sprung {
namespace {

/// The seed of a body, which does not depend on the other bodies.
std::uint64_t seed_of(const Scene& scene, const std::string& name) {
  std::uint64_t seed = mixed_bits(scene.settings.seed);
  for (const char letter : name) seed = mixed_bits(seed ^ static_cast<unsigned char>(letter));
  return seed;
}

bool breaks(const SpringMaterial& material) { return std::isfinite(material.break_strain); }

bool may_break(const BodyScene& body) {
  const auto kind_breaks = [](const std::optional<SpringMaterial>& kind) { return kind && breaks(*kind); };
  const SpringMaterials& kinds = body.springs;
  return kind_breaks(kinds.structural) || kind_breaks(kinds.shear) || kind_breaks(kinds.bend) ||
         std::ranges::any_of(body.spring_groups, breaks, &SpringGroupScene::material);
}

}  // namespace

void scatter_strength(const Scene& scene, const BodyScene& body, BodyShape& shape) {
  if (body.preset.empty() || scene.strength_scatter == 0.0) return;
  const std::uint64_t seed = seed_of(scene, body.name);
  Springs& springs = shape.springs;
  for (std::size_t s = 0; s < springs.laws.size(); ++s) {
    double& longest = springs.laws[s].break_length;
    const double rest = springs.rest_length[s];
    if (!springs.laws[s].breaks()) continue;
    longest = rest + (longest - rest) * (1.0 + scene.strength_scatter * (2.0 * random_number(seed, s) - 1.0));
  }
}

bool uses_seed(const Scene& scene) {
  const auto scatters = [](const BodyScene& body) { return !body.preset.empty() && may_break(body); };
  return scene.settings.perturb || (scene.strength_scatter > 0.0 && std::ranges::any_of(scene.bodies, scatters));
}

}  // namespace sprung
