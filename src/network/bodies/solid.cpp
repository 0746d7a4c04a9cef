#include "network/bodies/body_rules.h"
#include "network/bodies/body_shape.h"
#include "network/bodies/lattice.h"
#include "network/bodies/shape_parts.h"

namespace sprung {
namespace {

void check(const SolidShape& solid, const SpringMaterials& materials) {
  ProblemList problems;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    problems.require_positive(entry_key("size", axis), solid.size[static_cast<int>(axis)], "give the length of the side in m");
    problems.require_count(entry_key("resolution", axis), solid.resolution[axis], 2);
  }
  const auto& [x, y, z] = solid.resolution;
  require_affordable("resolution", counts_text(solid.resolution), static_cast<double>(x) * y * z, problems);
  refuse_angle_bends(materials, "a solid", problems);
  require_materials(materials, problems);
  problems.throw_if_any();
}

}  // namespace

BodyShape make_solid(const SolidShape& solid, const SpringMaterials& materials) {
  check(solid, materials);
  const Lattice lattice{solid.size, solid.resolution};
  BodyShape shape = shape_of_particles(lattice.positions(), materials);
  add_lattice_springs(lattice, materials, shape.springs);
  shape.cells = lattice_cells(lattice);

  std::vector<std::array<Index, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    add_layer_triangles(lattice, axis, 0, false, triangles);
    add_layer_triangles(lattice, axis, lattice.resolution[axis] - 1, true, triangles);
  }
  set_surface(shape, to_triangles(triangles));
  shape.dimension = 3;
  shape.measure = solid.size.prod();
  shape.measures = lattice.measures();
  return shape;
}

}  // namespace sprung
