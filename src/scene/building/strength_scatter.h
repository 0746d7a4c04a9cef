// The scatter of the strength of bodies with a material: "strength_scatter".
#pragma once

#include "network/bodies/body_shape.h"
#include "scene/format/scene.h"

namespace sprung {

/// Multiplies the break strain of each spring that breaks in a body with a material by a random factor. It is uniform between 1 - s
/// and 1 + s, where s is the scene's strength_scatter. It is a function of the scene's seed, the name of the body and the number of
/// the spring in the body.
void scatter_strength(const Scene& scene, const BodyScene& body, BodyShape& shape);

/// Whether the run depends on the scene's seed: by pushes off symmetry or by strengths that scatter.
[[nodiscard]] bool uses_seed(const Scene& scene);

}  // namespace sprung
