#include "network/bodies/body_rules.h"
#include "network/bodies/body_shape.h"
#include "network/bodies/lattice.h"
#include "network/bodies/shape_parts.h"

namespace sprung {
namespace {

void check(const ClothShape& cloth, const SpringMaterials& materials) {
  ProblemList problems;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    problems.require_positive(entry_key("size", axis), cloth.size[axis], "give the length of the side in m");
    problems.require_count(entry_key("resolution", axis), cloth.resolution[axis], 2);
  }
  require_affordable("resolution", counts_text(cloth.resolution), static_cast<double>(cloth.resolution[0]) * cloth.resolution[1],
                     problems);
  require_materials(materials, problems);
  problems.throw_if_any();
}

}  // namespace

BodyShape make_cloth(const ClothShape& cloth, const SpringMaterials& materials) {
  check(cloth, materials);
  const Lattice lattice{{cloth.size[0], cloth.size[1], 1.0}, {cloth.resolution[0], cloth.resolution[1], 1}};
  BodyShape shape = shape_of_particles(lattice.positions(), materials);
  add_lattice_springs(lattice, materials, shape.springs);
  if (materials.bend && materials.bend_model == SpringMaterials::BendModel::angle) {
    add_lattice_angle_bends(lattice, *materials.bend, shape.angle_bends);
  }

  std::vector<std::array<Index, 3>> triangles;
  add_layer_triangles(lattice, 2, 0, true, triangles);
  set_surface(shape, to_triangles(triangles));
  shape.dimension = 2;
  shape.measure = cloth.size[0] * cloth.size[1];
  shape.resolution = cloth.resolution;
  shape.measures = lattice.measures();
  return shape;
}

}  // namespace sprung
