// Random networks thrown at random obstacles that move, rotate and deform, with random steps: combinations that no other test has.
#include "base/error.h"
#include "base/test_seed.h"
#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle_shape.h"
#include "geometry/tetrahedra/box_meshes.h"
#include "mesh_shapes.h"
#include "network/bodies/tetrahedra_body.h"
#include "network/network_builder.h"
#include "scenarios/mesh_samples.h"
#include "scenarios/scenario.h"
#include "scene/building/lattice_filling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

namespace sprung::testing {
namespace {

using test::Random;

constexpr int kSteps = 60;

double one_of(Random& random, std::initializer_list<double> values) {
  return values.begin()[random.below(static_cast<Index>(values.size()))];
}

Matrix3 random_rotation(Random& random) {
  return rotation_from_degrees(180.0 * random.in_box({-Vector3::Ones(), Vector3::Ones()}));
}

/// A coarse cloth, a rope or a jelly, constrained by the stretch limit or by a few soft springs alone.
BodyShape random_shape(Random& random) {
  const SpringMaterial limp{.value = 0.0};
  const SpringMaterial soft{.value = 1.0, .damping = 0.01};
  const Index n = 3 + random.below(8);
  switch (random.below(3)) {
    case 0:
      return make_cloth({.size = {0.8, 0.8}, .resolution = {n, n}}, {limp, limp, limp});
    case 1:
      return make_rope({.points = {{-0.5, 0, 0}, {0.5, 0.1, 0}}, .particles = 2 * n, .length = {}}, {limp, {}, limp});
    default:
      return make_solid({.size = {0.3, 0.3, 0.3}, .resolution = {2 + n / 4, 2 + n / 4, 2 + n / 4}}, {soft, soft, {}});
  }
}

/// A rope, cloth or mesh that resists bending.
BodyShape random_bent_shape(Random& random) {
  const SpringMaterial limp{.value = 0.0};
  const SpringMaterial bend{.value = one_of(random, {0.0001, 0.001, 0.01}), .damping_time = 0.001};
  SpringMaterials materials{limp, {}, bend, SpringMaterials::BendModel::angle};
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

enum class Filled : std::uint8_t { lattice, coarse_lattice, tetrahedra, balloon };

/// A closed surface that cells carry, tetrahedra, or a skin around a gas or a liquid.
BodyShape random_filled_shape(Filled kind, Random& random) {
  const SpringMaterial limp{.value = 0.0};
  const SpringMaterial soft{.value = 1.0, .damping = 0.01};
  TriangleMesh surface = random.below(2) == 0 ? meshes::sphere(2) : meshes::torus();
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

/// Adds a body that flies towards the origin.
void add_flying_body(NetworkBuilder& builder, const std::string& name, BodyShape shape, Random& random,
                     const BodyContact& contact) {
  set_total_mass(shape, 1.0);
  const Vector3 direction = random.direction();
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = random_rotation(random);
  pose.translation() = -random.between(0.3, 1.0) * direction + 0.2 * random.direction();
  place(shape, pose, one_of(random, {0.0, 1.0, 10.0, 100.0}) * direction);
  const double friction = one_of(random, {0.0, 0.5, 2.0});
  builder.add_body(name, shape,
                   {.thickness = one_of(random, {0.0, 0.0005, 0.005, 0.02}),
                    .friction = friction,
                    .static_friction = friction,
                    .restitution = one_of(random, {0.0, 0.5})},
                   contact);
}

void add_random_body(NetworkBuilder& builder, const std::string& name, Random& random, const BodyContact& contact) {
  add_flying_body(builder, name, random_shape(random), random, contact);
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

ObstacleGeometry random_geometry(Random& random) {
  switch (random.below(3)) {
    case 0:
      return random_primitive(random);
    case 1:
      return deforming(random_mesh(random), random);
    default:
      return random_mesh(random);
  }
}

Obstacle random_obstacle(Random& random) {
  Obstacle obstacle{.name = "obstacle", .geometry = random_geometry(random)};
  obstacle.rest_pose.linear() = random_rotation(random);
  obstacle.material = {.thickness = one_of(random, {0.0, 0.002}), .friction = 0.5, .static_friction = 0.5};
  if (random.below(2) == 0) return obstacle;
  obstacle.motion.keyframes = {{.time = 0.0},
                               {.time = 1.0,
                                .position = one_of(random, {0.3, 3.0, 30.0}) * random.direction(),
                                .rotation = one_of(random, {0.0, 90.0, 1000.0}) * random.direction()}};
  return obstacle;
}

BuiltScene random_scene(Random& random, const NetworkBuilder& builder, std::vector<Obstacle> obstacles) {
  BuiltScene scene;
  scene.network = builder.build();
  scene.obstacles = std::move(obstacles);
  scene.settings.step = one_of(random, {1.0 / 1000.0, 1.0 / 240.0, 1.0 / 60.0});
  scene.settings.stability = StabilityCheck::warn;
  scene.settings.stretch_limit = StretchLimitSettings{.iterations = 5 + random.below(20)};
  scene.frames = kSteps + 1;
  return scene;
}

using Reports = std::vector<std::pair<std::uint64_t, ScenarioReport>>;

/// Runs scenes that `make` builds from random numbers, except those that start with an intersection or are not `wanted`.
template <class Make, class Wanted>
Reports run_scenes(std::uint64_t scenes, Judge judge, const Make& make, const Wanted& wanted) {
  Reports reports;
  for (std::uint64_t number = 0; number < scenes; ++number) {
    Random random(test::seeded(number));
    BuiltScene scene = make(random);
    if (!wanted(scene)) continue;
    try {
      reports.emplace_back(number, run_scenario(std::move(scene), {}, judge));
    } catch (const InputError&) {
      continue;
    }
  }
  return reports;
}

bool deforms(const BuiltScene& scene) { return std::holds_alternative<SequenceGeometry>(scene.obstacles.front().geometry); }

/// A rigid obstacle that swings above a floor and always leaves room between the two.
std::vector<Obstacle> swing_above_floor(Random& random) {
  Obstacle obstacle{.name = "swings"};
  if (random.below(2) == 0) {
    obstacle.geometry = random_primitive(random);
  } else {
    obstacle.geometry = random_mesh(random);
  }
  const TriangleMesh mesh = obstacle_mesh(obstacle.geometry, 0.0, 0.0);
  const double radius = mesh.vertices.colwise().norm().maxCoeff();
  constexpr double kSwing = 0.3;
  const double period = one_of(random, {0.1, 0.3, 1.0});
  const Vector3 position = kSwing * random.direction();
  const Vector3 rotation = one_of(random, {0.0, 90.0, 500.0}) * random.direction();
  for (int k = 0; 0.5 * k * period < 1.0; ++k) {
    const double fraction = k % 2;
    obstacle.motion.keyframes.push_back(
        {.time = 0.5 * k * period, .position = fraction * position, .rotation = fraction * rotation});
  }
  const ContactMaterial rough{.friction = 0.3, .static_friction = 0.3};
  obstacle.material = rough;
  const double room = one_of(random, {0.05, 0.3});
  return {obstacle, {.name = "floor", .geometry = HalfSpaceGeometry{.offset = -radius - kSwing - room}, .material = rough}};
}

BuiltScene scene_of_one(Random& random) {
  NetworkBuilder builder;
  add_random_body(builder, "body", random, {.self = false});
  return random_scene(random, builder, {random_obstacle(random)});
}

/// Whether the pin comes within `distance` [m] of the obstacle at any time of the scene.
bool comes_near(const Pin& pin, const Vector3& pinned, const Obstacle& obstacle, double distance, double duration) {
  const std::unique_ptr<const ObstacleShape> shape = make_shape(obstacle.geometry);
  const RigidTransform origin(Eigen::Translation3d(pin.origin));
  constexpr int kTimes = 400;
  for (int k = 0; k <= kTimes; ++k) {
    const double time = duration * k / kTimes;
    const Vector3 position = pin.motion.pose(origin, time) * origin.inverse() * pinned;
    const Vector3 local = obstacle.motion.pose(obstacle.rest_pose, time).inverse() * position;
    if (shape->nearest(local, distance) || shape->contains(local)) return true;
  }
  return false;
}

/// A body with one or two pinned particles, and a primitive. Either the pins or the primitive move.
BuiltScene scene_with_pins(Random& random, bool self) {
  NetworkBuilder builder;
  add_random_body(builder, "body", random, {.self = self});
  Obstacle obstacle = swing_above_floor(random).front();
  obstacle.geometry = random_primitive(random);
  Motion of_pins;
  if (random.below(2) == 0) std::swap(of_pins, obstacle.motion);
  const Index count = builder.build().particle_count();
  const Index first = random.below(count);
  const Index second = random.below(2 * count);
  builder.pin(first, of_pins);
  if (second < count && second != first) builder.pin(second, of_pins);
  return random_scene(random, builder, {obstacle});
}

/// Whether the obstacle stays away from all pins and no spring joins two pins. The free particles around a pin then have room
/// beside the obstacle.
bool has_room_around_pins(const BuiltScene& scene) {
  constexpr double kRoom = 0.03;
  const auto is_pinned = [&](Index i) { return scene.network.inverse_masses[i] == 0.0; };
  const Springs& springs = scene.network.springs;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    if (is_pinned(springs.first[s]) && is_pinned(springs.second[s])) return false;
  }
  return std::ranges::none_of(scene.network.pins, [&](const Pin& pin) {
    return comes_near(pin, scene.network.positions.col(pin.particles.front()), scene.obstacles.front(), kRoom,
                      kSteps * scene.settings.step);
  });
}

NetworkBuilder three_bodies(Random& random) {
  NetworkBuilder builder;
  for (const char* name : {"first", "second", "third"}) add_random_body(builder, name, random, {.self = true});
  return builder;
}

BuiltScene scene_of_three(Random& random) {
  const NetworkBuilder builder = three_bodies(random);
  return random_scene(random, builder, {random_obstacle(random)});
}

BuiltScene scene_above_floor(Random& random) {
  const NetworkBuilder builder = three_bodies(random);
  return random_scene(random, builder, swing_above_floor(random));
}

BuiltScene scene_of_filled(Filled kind, Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "body", random_filled_shape(kind, random), random, {.self = false});
  return random_scene(random, builder, {random_obstacle(random)});
}

/// A lattice, tetrahedra and a balloon that meet at an obstacle above a floor.
BuiltScene scene_of_three_filled(Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "lattice", random_filled_shape(Filled::lattice, random), random, {.self = true});
  add_flying_body(builder, "tetrahedra", random_filled_shape(Filled::tetrahedra, random), random, {.self = true});
  add_flying_body(builder, "balloon", random_filled_shape(Filled::balloon, random), random, {.self = true});
  return random_scene(random, builder, swing_above_floor(random));
}

/// A rod or spring between particles of two bodies, a body's surface, or an obstacle. It may begin late, end early and break.
Attachment random_attachment(const SpringNetwork& network, Index obstacles, Random& random) {
  const auto particle_of = [&](const Body& body) { return body.first_particle + random.below(body.particle_count); };
  const Index bodies = static_cast<Index>(network.bodies.size());
  const Index first = random.below(bodies);
  const Index second = (first + 1 + random.below(bodies - 1)) % bodies;
  Attachment attachment;
  attachment.particles = {particle_of(network.bodies[static_cast<std::size_t>(first)])};
  switch (random.below(3)) {
    case 0:
      attachment.second = ParticleEnds{.particles = {particle_of(network.bodies[static_cast<std::size_t>(second)])}};
      break;
    case 1:
      attachment.second = SurfaceEnd{.body = second};
      break;
    default:
      attachment.second = ObstacleEnd{.obstacle = random.below(obstacles)};
  }
  if (random.below(2) == 0) attachment.stiffness = one_of(random, {1.0, 100.0});
  if (random.below(2) == 0) attachment.rest_length = random.between(0.0, 0.3);
  if (random.below(4) == 0) attachment.break_force = one_of(random, {1.0, 100.0});
  attachment.from = one_of(random, {0.0, 0.05});
  if (random.below(4) == 0) attachment.until = 0.15;
  return attachment;
}

/// Attachments join the bodies to each other and to an obstacle that swings above a floor.
BuiltScene attached(NetworkBuilder builder, bool rods_alone, Random& random) {
  std::vector<Obstacle> obstacles = swing_above_floor(random);
  const SpringNetwork network = builder.build();
  for (int k = 0; k < 4; ++k) {
    Attachment attachment = random_attachment(network, static_cast<Index>(obstacles.size()), random);
    attachment.name = "attachment " + std::to_string(k);
    if (rods_alone) attachment.stiffness.reset();
    builder.add_attachment(std::move(attachment));
  }
  return random_scene(random, builder, std::move(obstacles));
}

BuiltScene scene_of_attached(Random& random) { return attached(three_bodies(random), false, random); }

/// A lattice of a coarse mesh, and two ropes, cloths or meshes that resist bending.
BuiltScene scene_of_rods(Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "lattice", random_filled_shape(Filled::coarse_lattice, random), random, {.self = true});
  add_flying_body(builder, "first", random_bent_shape(random), random, {.self = true});
  add_flying_body(builder, "second", random_bent_shape(random), random, {.self = true});
  return attached(std::move(builder), true, random);
}

class RandomScenes : public test::SeededTest {};

TEST_F(RandomScenes, NothingCrossesAnyObstacleInAnyStep) {
  const Reports reports = run_scenes(500, Judge::obstacles, scene_of_one, [](const BuiltScene&) { return true; });
  for (const auto& [number, report] : reports) EXPECT_TRUE(report.is_free()) << "scene " << number << ": " << report;
  EXPECT_GT(reports.size(), 250);
}

// With a single rigid obstacle an admissible position always exists.
TEST_F(RandomScenes, NothingCrossesItselfOrAnotherOrARigidObstacleInAnyStep) {
  const Reports reports =
      run_scenes(200, Judge::obstacles_and_self, scene_of_three, [](const BuiltScene& scene) { return !deforms(scene); });
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() && report.infeasible == 0) << "scene " << number << ": " << report;
  }
  EXPECT_GT(reports.size(), 40);
}

// There is room between obstacle and floor, though it may be found only in substeps.
TEST_F(RandomScenes, NothingCrossesItselfOrAnotherBetweenAMovingObstacleAndAFloor) {
  const Reports reports = run_scenes(200, Judge::obstacles_and_self, scene_above_floor, [](const BuiltScene&) { return true; });
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() && report.infeasible == 0) << "scene " << number << ": " << report;
  }
  EXPECT_GT(reports.size(), 40);
}

// An obstacle that pushes the neighbours of a pin around it moves them farther than it moves itself.
TEST_F(RandomScenes, NothingCrossesBesideItsPins) {
  const auto make = [](Random& random) { return scene_with_pins(random, false); };
  const Reports reports = run_scenes(1000, Judge::obstacles, make, has_room_around_pins);
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() && report.infeasible == 0) << "scene " << number << ": " << report;
  }
  EXPECT_GT(reports.size(), 250);
}

// Elements tangled at a pin move rigidly with it. They have no admissible position if that motion drives them into the obstacle.
// This is rare, and it is reported.
TEST_F(RandomScenes, NothingCrossesItselfBesideItsPins) {
  const auto make = [](Random& random) { return scene_with_pins(random, true); };
  const Reports reports = run_scenes(300, Judge::obstacles_and_self, make, has_room_around_pins);
  std::size_t infeasible = 0;
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() || report.infeasible > 0) << "scene " << number << ": " << report;
    if (report.infeasible > 0) ++infeasible;
  }
  EXPECT_LE(infeasible, reports.size() / 100);
  EXPECT_GT(reports.size(), 100);
}

TEST_F(RandomScenes, NothingCrossesItselfOrAnotherOrADeformingSurface) {
  const Reports reports = run_scenes(200, Judge::obstacles_and_self, scene_of_three, deforms);
  for (const auto& [number, report] : reports) EXPECT_TRUE(report.is_free()) << "scene " << number << ": " << report;
  EXPECT_GT(reports.size(), 10);
}

// Rods give way to contact.
TEST_F(RandomScenes, NothingCrossesWhateverIsAttached) {
  const Reports reports = run_scenes(100, Judge::obstacles_and_self, scene_of_attached, [](const BuiltScene&) { return true; });
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() && report.infeasible == 0) << "scene " << number << ": " << report;
  }
  EXPECT_GT(reports.size(), 20);
}

TEST_F(RandomScenes, NothingCrossesWhereRodsJoinCoarseLatticesAndBends) {
  const Reports reports = run_scenes(20, Judge::obstacles_and_self, scene_of_rods, [](const BuiltScene&) { return true; });
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() && report.infeasible == 0) << "scene " << number << ": " << report;
  }
  EXPECT_GT(reports.size(), 0);
}

TEST_F(RandomScenes, NoLatticeTetrahedraOrBalloonCrossesAnObstacleInAnyStep) {
  for (const Filled kind : {Filled::lattice, Filled::coarse_lattice, Filled::tetrahedra, Filled::balloon}) {
    const auto make = [&](Random& random) { return scene_of_filled(kind, random); };
    const Reports reports = run_scenes(12, Judge::obstacles, make, [](const BuiltScene&) { return true; });
    for (const auto& [number, report] : reports) {
      EXPECT_TRUE(report.is_free()) << "kind " << static_cast<int>(kind) << ", scene " << number << ": " << report;
      EXPECT_EQ(report.inverted, 0) << "kind " << static_cast<int>(kind) << ", scene " << number << ": " << report;
    }
    EXPECT_GT(reports.size(), 3) << "of kind " << static_cast<int>(kind);
  }
}

TEST_F(RandomScenes, LatticesTetrahedraAndBalloonsDoNotCrossEachOtherOrThemselves) {
  const Reports reports = run_scenes(4, Judge::obstacles_and_self, scene_of_three_filled, [](const BuiltScene&) { return true; });
  for (const auto& [number, report] : reports) {
    EXPECT_TRUE(report.is_free() && report.infeasible == 0 && report.inverted == 0) << "scene " << number << ": " << report;
  }
  EXPECT_GT(reports.size(), 0);
}

}  // namespace
}  // namespace sprung::testing
