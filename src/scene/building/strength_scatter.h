// The scatter of the strength of bodies with a material: "strength_scatter".
#pragma once

#include "network/bodies/body_shape.h"
#include "scene/format/scene.h"

namespace sprung {

/// Multiplies the break strain of each spring of a body that has a material by a factor between 1 - s and 1 + s, s the scene's
/// strength_scatter: uniform, and a function of the scene's seed, the name of the body and the number of the spring. Springs that
/// do not break stay as they are.
void scatter_strength(const Scene& scene, const BodyScene& body, BodyShape& shape);

/// Whether the run depends on the scene's seed: by pushes off symmetry or by the scatter of a strength.
[[nodiscard]] bool uses_seed(const Scene& scene);

}  // namespace sprung
