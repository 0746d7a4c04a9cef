#include "scenarios/random_shapes.h"

#include "geometry/tetrahedra/box_meshes.h"
#include "mesh_shapes.h"
#include "network/bodies/tetrahedra_body.h"
#include "scenarios/mesh_samples.h"
#include "scene/building/lattice_filling.h"

#include <memory>
#include <utility>

namespace sprung::testing {
namespace {

constexpr double kSwing = 0.3;  // [m]

/// One time in three, with springs that yield, break or both.
SpringMaterial random_law(SpringMaterial material, bool may_break, Random& random) {
  if (random.below(3) > 0) return material;
  // The stretch limit leaves out such springs, so that they need a stiffness.
  material.value = one_of(random, {1.0, 100.0});
  const Index kind = may_break ? random.below(3) : 0;
  if (kind != 1) material.yield = one_of(random, {0.02, 0.2});
  if (kind != 0) material.break_strain = one_of(random, {0.05, 0.3});
  return material;
}

MeshGeometry random_mesh(Random& random) {
  const auto make = [](TriangleMesh mesh, bool closed) {
    return MeshGeometry{.mesh = std::make_shared<const TriangleMesh>(std::move(mesh)), .closed = closed};
  };
  switch (random.below(5)) {
    case 0:
      return make(meshes::torus(), true);
    case 1:
      return make(meshes::funnel(), true);
    case 2:
      return make(meshes::spike(), true);
    case 3: {
      TriangleMesh needles = test::needles(18);
      needles.vertices *= 0.5;
      return make(std::move(needles), true);
    }
    default: {
      const PolygonMesh sheet = meshes::thin_sheet();
      return make({sheet.vertices, triangulate(sheet.faces)}, false);
    }
  }
}

/// The mesh, sheared and stretched by up to one or three tenths, differently in each frame.
SequenceGeometry deforming(const MeshGeometry& rest, Random& random) {
  MeshSequence sequence;
  sequence.triangles = rest.mesh->triangles;
  sequence.frame_rate = one_of(random, {2.0, 10.0, 30.0});
  const double most = one_of(random, {0.1, 0.3});
  sequence.loop = true;
  for (int frame = 0; frame < 4; ++frame) {
    Matrix3 map = Matrix3::Identity();
    for (double& entry : map.reshaped()) entry += random.between(-most, most);
    sequence.frames.push_back(map * rest.mesh->vertices);
  }
  return {.sequence = std::make_shared<const MeshSequence>(std::move(sequence)), .closed = rest.closed};
}

}  // namespace

double one_of(Random& random, std::initializer_list<double> values) {
  return values.begin()[random.below(static_cast<Index>(values.size()))];
}

Matrix3 random_rotation(Random& random) {
  return rotation_from_degrees(180.0 * random.in_box({-Vector3::Ones(), Vector3::Ones()}));
}

BodyShape random_shape(Random& random) {
  const SpringMaterial limp{.value = 0.0};
  const Index n = 3 + random.below(8);
  const Index kind = random.below(3);
  if (kind == 2) {
    const SpringMaterial soft = random_law({.value = 1.0, .damping = 0.01}, false, random);
    return make_solid({.size = {0.3, 0.3, 0.3}, .resolution = {2 + n / 4, 2 + n / 4, 2 + n / 4}}, {soft, soft, {}});
  }
  const SpringMaterial material = random_law(limp, true, random);
  if (kind == 0) return make_cloth({.size = {0.8, 0.8}, .resolution = {n, n}}, {material, material, limp});
  return make_rope({.points = {{-0.5, 0, 0}, {0.5, 0.1, 0}}, .particles = 2 * n, .length = {}}, {material, {}, limp});
}

BodyShape random_bent_shape(Random& random) {
  const SpringMaterial limp{.value = 0.0};
  const SpringMaterial bend{.value = one_of(random, {0.0001, 0.001, 0.01}), .damping_time = 0.001};
  SpringMaterials materials{random_law(limp, true, random), {}, bend, SpringMaterials::BendModel::angle};
  const Index n = 3 + random.below(8);
  const Index kind = random.below(3);
  if (kind == 2) {
    materials.bend->measure = SpringMaterial::Measure::modulus;
    const Pattern pattern = kPatterns.at(static_cast<std::size_t>(random.below(static_cast<Index>(kPatterns.size()))));
    const Index squares = n / 2 + 1;
    return make_mesh_body(sheet(pattern, {squares, squares}, 0.8 / squares, [](const Vector3&) { return true; }), materials);
  }
  if (kind == 0) return make_cloth({.size = {0.8, 0.8}, .resolution = {n, n}}, materials);
  return make_rope({.points = {{-0.5, 0, 0}, {0, 0.1, 0}, {0.5, 0, 0}}, .particles = 2 * n, .length = {}}, materials);
}

BodyShape random_filled_shape(Filled kind, Random& random) {
  const SpringMaterial limp{.value = 0.0};
  const SpringMaterial soft{.value = 1.0, .damping = 0.01};
  TriangleMesh surface = random.below(2) == 0 ? meshes::sphere(2) : test::torus(1.0, 0.4, 16, 8);
  surface.vertices *= 0.2;
  PolygonMesh skin{surface.vertices, to_polygons(surface.triangles), Edges(2, 0)};
  BodyShape shape;
  switch (kind) {
    case Filled::lattice:
      shape = make_lattice_body(fill_with_cells(std::move(skin), random.between(0.05, 0.15)), {soft, soft, {}});
      shape.preserve_volume = random.below(2) == 0;
      break;
    case Filled::coarse_lattice: {
      // Of 12 vertices, with edges of one to five cells.
      const Vector3 radii = random.in_box({Vector3::Constant(0.12), Vector3::Constant(0.3)});
      TriangleMesh icosahedron = meshes::sphere(0);
      icosahedron.vertices = radii.asDiagonal() * icosahedron.vertices;
      skin = {icosahedron.vertices, to_polygons(icosahedron.triangles), Edges(2, 0)};
      shape = make_lattice_body(fill_with_cells(std::move(skin), random.between(0.06, 0.12)), {soft, soft, {}});
      shape.preserve_volume = random.below(2) == 0;
      break;
    }
    case Filled::tetrahedra: {
      TetrahedraMesh box = test::make_box({1 + random.below(3), 1 + random.below(3), 1 + random.below(3)}, 0.1,
                                          random.below(2) == 0 ? test::Cut::five : test::Cut::mirrored);
      test::jitter(box, 0.02, static_cast<unsigned>(random.below(1000)));
      shape = make_tetrahedra_body(box, {soft, {}, {}});
      shape.preserve_volume = random.below(2) == 0;
      break;
    }
    case Filled::balloon:
      shape = make_mesh_body(skin, {limp, {}, {}});
      (random.below(2) == 0 ? shape.pressure : shape.volume_factor) = random.between(0.5, 1.5);
      break;
  }
  return shape;
}

ObstacleGeometry random_primitive(Random& random) {
  switch (random.below(6)) {
    case 0:
      return SphereGeometry{.radius = 0.2};
    case 1:
      return BoxGeometry{.size = {0.5, 0.02, 0.4}};
    case 2:
      return CapsuleGeometry{.radius = 0.05, .length = 0.4};
    case 3:
      return CylinderGeometry{.radius = 0.1, .height = 0.3};
    case 4:
      return ConeGeometry{.radius = 0.1, .height = 0.5};
    default:
      return EllipsoidGeometry{.radii = {0.05, 0.2, 0.3}};
  }
}

Motion swing(double begin, Random& random) {
  const double period = one_of(random, {0.1, 0.3, 1.0});
  const Vector3 position = kSwing * random.direction();
  const Vector3 rotation = one_of(random, {0.0, 90.0, 500.0}) * random.direction();
  Motion motion;
  for (int k = 0; 0.5 * k * period < 1.0; ++k) {
    const double fraction = k % 2;
    motion.keyframes.push_back(
        {.time = begin + 0.5 * k * period, .position = fraction * position, .rotation = fraction * rotation});
  }
  return motion;
}

Obstacle random_obstacle(Random& random) {
  Obstacle obstacle{.name = "obstacle"};
  switch (random.below(3)) {
    case 0:
      obstacle.geometry = random_primitive(random);
      break;
    case 1:
      obstacle.geometry = deforming(random_mesh(random), random);
      break;
    default:
      obstacle.geometry = random_mesh(random);
  }
  obstacle.rest_pose.linear() = random_rotation(random);
  obstacle.material = {.thickness = one_of(random, {0.0, 0.002}), .friction = 0.5, .static_friction = 0.5};
  if (random.below(2) == 0) return obstacle;
  obstacle.motion.keyframes = {{.time = 0.0},
                               {.time = 1.0,
                                .position = one_of(random, {0.3, 3.0, 30.0}) * random.direction(),
                                .rotation = one_of(random, {0.0, 90.0, 1000.0}) * random.direction()}};
  return obstacle;
}

std::vector<Obstacle> swing_above_floor(double begin, Random& random) {
  Obstacle obstacle{.name = "swings", .motion = swing(begin, random)};
  if (random.below(2) == 0) {
    obstacle.geometry = random_primitive(random);
  } else {
    obstacle.geometry = random_mesh(random);
  }
  const TriangleMesh mesh = obstacle_mesh(obstacle.geometry, 0.0, 0.0);
  const double radius = mesh.vertices.colwise().norm().maxCoeff();
  const ContactMaterial rough{.friction = 0.3, .static_friction = 0.3};
  obstacle.material = rough;
  const double room = one_of(random, {0.05, 0.3});
  return {obstacle, {.name = "floor", .geometry = HalfSpaceGeometry{.offset = -radius - kSwing - room}, .material = rough}};
}

}  // namespace sprung::testing
