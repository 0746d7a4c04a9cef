// Names of the corners of ropes, cloths and solids, for pins.
#pragma once

#include "network/bodies/body_shape.h"

#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// In the order of their particles: `from`, `to` of a rope; `min_min`, `max_min`, ... (x, then y) of a cloth; `min_min_min`, ...
/// (x, then y, then z) of a solid.
[[nodiscard]] std::vector<std::string> corner_names(const RopeShape& rope);
[[nodiscard]] std::vector<std::string> corner_names(const ClothShape& cloth);
[[nodiscard]] std::vector<std::string> corner_names(const SolidShape& solid);

/// The body's particle at a corner; none if the shape has no corner of that name.
[[nodiscard]] std::optional<Index> corner_particle(const RopeShape& rope, std::string_view name);
[[nodiscard]] std::optional<Index> corner_particle(const ClothShape& cloth, std::string_view name);
[[nodiscard]] std::optional<Index> corner_particle(const SolidShape& solid, std::string_view name);

}  // namespace sprung
