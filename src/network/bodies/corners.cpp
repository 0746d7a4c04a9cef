#include "network/bodies/corners.h"

#include <algorithm>
#include <span>

namespace sprung {
namespace {

std::vector<std::string> grid_corner_names(std::size_t axes) {
  std::vector<std::string> names;
  for (std::size_t corner = 0; corner < (std::size_t{1} << axes); ++corner) {
    std::string name;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      if (axis > 0) name += '_';
      name += (corner >> axis & 1U) != 0 ? "max" : "min";
    }
    names.push_back(name);
  }
  return names;
}

std::optional<std::size_t> position_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::optional<Index> grid_corner_particle(std::span<const Index> resolution, std::string_view name) {
  const std::optional<std::size_t> corner = position_of(grid_corner_names(resolution.size()), name);
  if (!corner) return std::nullopt;
  Index particle = 0;
  Index stride = 1;
  for (std::size_t axis = 0; axis < resolution.size(); ++axis) {
    if ((*corner >> axis & 1U) != 0) particle += stride * (resolution[axis] - 1);
    stride *= resolution[axis];
  }
  return particle;
}

}  // namespace

std::vector<std::string> corner_names(const RopeShape& /*rope*/) { return {"from", "to"}; }
std::vector<std::string> corner_names(const ClothShape& cloth) { return grid_corner_names(cloth.resolution.size()); }
std::vector<std::string> corner_names(const SolidShape& solid) { return grid_corner_names(solid.resolution.size()); }

std::optional<Index> corner_particle(const RopeShape& rope, std::string_view name) {
  if (name == "from") return 0;
  if (name == "to") return rope.particles.value_or(static_cast<Index>(rope.points.size())) - 1;
  return std::nullopt;
}

std::optional<Index> corner_particle(const ClothShape& cloth, std::string_view name) {
  return grid_corner_particle(cloth.resolution, name);
}

std::optional<Index> corner_particle(const SolidShape& solid, std::string_view name) {
  return grid_corner_particle(solid.resolution, name);
}

}  // namespace sprung
