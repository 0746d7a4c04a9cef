#include "scenarios/random_scene.h"

#include "base/error.h"
#include "collision/shapes/obstacle_shape.h"
#include "network/network_builder.h"
#include "scenarios/random_shapes.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

constexpr int kSteps = 60;

/// A pose with which a body that flies along `direction` comes near the origin.
RigidTransform thrown_from(const Vector3& direction, Random& random) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = random_rotation(random);
  pose.translation() = -random.between(0.3, 1.0) * direction + 0.2 * random.direction();
  return pose;
}

void add_body(NetworkBuilder& builder, const std::string& name, BodyShape shape, const RigidTransform& pose,
              const Vector3& velocity, bool self, Random& random) {
  set_total_mass(shape, 1.0);
  place(shape, pose, velocity);
  const double friction = one_of(random, {0.0, 0.5, 2.0});
  builder.add_body(name, shape,
                   {.thickness = one_of(random, {0.0, 0.0005, 0.005, 0.02}),
                    .friction = friction,
                    .static_friction = friction,
                    .restitution = one_of(random, {0.0, 0.5})},
                   {.self = self});
}

/// Adds a body that flies towards the origin.
void add_flying_body(NetworkBuilder& builder, const std::string& name, BodyShape shape, bool self, Random& random) {
  const Vector3 direction = random.direction();
  const RigidTransform pose = thrown_from(direction, random);
  add_body(builder, name, std::move(shape), pose, one_of(random, {0.0, 1.0, 10.0, 100.0}) * direction, self, random);
}

NetworkBuilder three_bodies(Random& random) {
  NetworkBuilder builder;
  for (const char* name : {"first", "second", "third"}) add_flying_body(builder, name, random_shape(random), true, random);
  return builder;
}

SimulatorSettings random_settings(const IntegratorSettings& integrator, Random& random) {
  SimulatorSettings settings;
  settings.step = one_of(random, {1.0 / 1000.0, 1.0 / 240.0, 1.0 / 60.0});
  settings.stability = StabilityCheck::warn;
  settings.stretch_limit = StretchLimitSettings{.iterations = 5 + random.below(20)};
  settings.sleep = random.below(2) == 0;
  settings.integrator = integrator;
  if (auto* verlet = std::get_if<VerletSettings>(&settings.integrator)) {
    verlet->damping = one_of(random, {0.0, 0.01});
    verlet->damping_rate = one_of(random, {0.0, 0.5});
    verlet->start_at_rest = random.below(4) == 0;
  }
  return settings;
}

RandomScene make_scene(const NetworkBuilder& builder, std::vector<Obstacle> obstacles, const SimulatorSettings& settings,
                       Random& random) {
  RandomScene made;
  BuiltScene& scene = made.scene;
  scene.network = builder.build();
  scene.obstacles = std::move(obstacles);
  scene.settings = settings;
  scene.frames = kSteps + 1;
  const SpectralBounds bounds = simulation_bounds(scene.network, settings, true);
  scene.largest_stable_step = largest_stable_step(settings.integrator, bounds);
  if (is_unstable(settings.step, scene.largest_stable_step) && random.below(2) == 0) {
    scene.settings.step = advised_step(settings.integrator, bounds);
  }
  return made;
}

double duration(const BuiltScene& scene) { return (scene.frames - 1) * scene.settings.steps_per_frame * scene.settings.step; }

bool deforms(const BuiltScene& scene) { return std::holds_alternative<SequenceGeometry>(scene.obstacles.front().geometry); }

/// A pin of one or two particles of a body that rests, moves or follows the first obstacle. It may begin late and end early.
Pin random_pin(const BuiltScene& scene, Random& random) {
  const Body& body = scene.network.bodies[static_cast<std::size_t>(random.below(static_cast<Index>(scene.network.bodies.size())))];
  const double end = duration(scene);
  Pin pin;
  pin.particles = {body.first_particle + random.below(body.particle_count)};
  const Index second = body.first_particle + random.below(2 * body.particle_count);
  if (second < body.first_particle + body.particle_count && second != pin.particles.front()) pin.particles.push_back(second);
  if (random.below(2) == 0) pin.from = random.between(0.1, 0.8) * end;
  if (random.below(2) == 0) pin.until = random.between(pin.from, 1.1 * end);
  switch (random.below(3)) {
    case 0:
      break;
    case 1:
      pin.motion = swing(pin.from, random);
      break;
    default:
      pin.obstacle = 0;
  }
  return pin;
}

void add_pin(const Pin& pin, NetworkBuilder builder, BuiltScene& scene) {
  builder.add_pin(pin);
  scene.network = builder.build();
}

/// Whether the pin comes within `distance` [m] of the obstacle at any time of the scene.
bool comes_near(const Pin& pin, const Vector3& pinned, const Obstacle& obstacle, double distance, double duration) {
  const std::unique_ptr<const ObstacleShape> shape = make_shape(obstacle.geometry);
  const RigidTransform origin(Eigen::Translation3d(pin.origin));
  constexpr int kTimes = 400;
  for (int k = 0; k <= kTimes; ++k) {
    const double time = pin.obstacle != kNone ? 0.0 : duration * k / kTimes;
    const Vector3 position = pin.motion.pose(origin, time) * origin.inverse() * pinned;
    const Vector3 local = obstacle.motion.pose(obstacle.rest_pose, time).inverse() * position;
    if (shape->nearest(local, distance) || shape->contains(local)) return true;
  }
  return false;
}

/// Whether the obstacle stays away from a pin that holds from the start, and no spring joins two of its particles. The free
/// particles around it then have room beside the obstacle.
bool has_room(const Pin& pin, const BuiltScene& scene) {
  constexpr double kRoom = 0.03;
  const auto is_pinned = [&](Index i) { return std::ranges::count(pin.particles, i) > 0; };
  const Springs& springs = scene.network.springs;
  for (Index s = 0; s < springs.count(); ++s) {
    if (is_pinned(springs.first[s]) && is_pinned(springs.second[s])) return false;
  }
  return std::ranges::none_of(pin.particles, [&](Index i) {
    return comes_near(pin, scene.network.positions.col(i), scene.obstacles.front(), kRoom, duration(scene));
  });
}

/// One scene in four, with a pin. It may drive its particles into anything.
RandomScene with_pin_in_some(RandomScene made, const NetworkBuilder& builder, Random& random) {
  if (random.below(4) > 0) return made;
  add_pin(random_pin(made.scene, random), builder, made.scene);
  made.kind += " and a pin";
  made.law = Law::reported;
  made.keeps_cells = false;
  return made;
}

RandomScene scene_of_one(const SimulatorSettings& settings, Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "body", random_shape(random), false, random);
  RandomScene made = make_scene(builder, {random_obstacle(random)}, settings, random);
  made.kind = "one body";
  made.judge = Judge::obstacles;
  made.law = deforms(made.scene) ? Law::free : Law::feasible;
  return with_pin_in_some(std::move(made), builder, random);
}

/// With a single rigid obstacle an admissible position always exists.
RandomScene scene_of_three(const SimulatorSettings& settings, Random& random) {
  const NetworkBuilder builder = three_bodies(random);
  RandomScene made = make_scene(builder, {random_obstacle(random)}, settings, random);
  made.kind = "three bodies";
  made.law = deforms(made.scene) ? Law::free : Law::feasible;
  return with_pin_in_some(std::move(made), builder, random);
}

/// There is room between obstacle and floor, though it may be found only in substeps.
RandomScene scene_above_floor(const SimulatorSettings& settings, Random& random) {
  const NetworkBuilder builder = three_bodies(random);
  RandomScene made = make_scene(builder, swing_above_floor(0.0, random), settings, random);
  made.kind = "three bodies above a floor";
  return with_pin_in_some(std::move(made), builder, random);
}

/// A body with a pin, and a primitive; none if the pin holds from the start and has no room. An obstacle that pushes the neighbours
/// of a pin around it moves them farther than it moves itself. Elements that are tangled at a pin move rigidly with it: they may
/// have no admissible position if that motion drives them into the obstacle, which is rare.
std::optional<RandomScene> scene_with_pin(bool self, const SimulatorSettings& settings, Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "body", random_shape(random), self, random);
  Obstacle obstacle{.name = "obstacle", .geometry = random_primitive(random)};
  if (random.below(2) == 0) obstacle.motion = swing(0.0, random);
  RandomScene made = make_scene(builder, {obstacle}, settings, random);
  made.kind = self ? "a pinned body that meets itself" : "a pinned body";
  if (!self) made.judge = Judge::obstacles;
  const Pin pin = random_pin(made.scene, random);
  if (pin.from > 0.0) {
    made.law = Law::reported;
  } else if (!has_room(pin, made.scene)) {
    return std::nullopt;
  }
  add_pin(pin, builder, made.scene);
  return made;
}

RandomScene scene_of_filled(const SimulatorSettings& settings, Random& random) {
  constexpr std::array kKinds{Filled::lattice, Filled::coarse_lattice, Filled::tetrahedra, Filled::balloon};
  NetworkBuilder builder;
  const Filled filled = kKinds.at(static_cast<std::size_t>(random.below(static_cast<Index>(kKinds.size()))));
  add_flying_body(builder, "body", random_filled_shape(filled, random), false, random);
  RandomScene made = make_scene(builder, {random_obstacle(random)}, settings, random);
  made.kind = "a filled body";
  made.judge = Judge::obstacles;
  made.law = deforms(made.scene) ? Law::free : Law::feasible;
  made.keeps_cells = true;
  return with_pin_in_some(std::move(made), builder, random);
}

/// A lattice, tetrahedra and a balloon that meet at an obstacle above a floor.
RandomScene scene_of_three_filled(const SimulatorSettings& settings, Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "lattice", random_filled_shape(Filled::lattice, random), true, random);
  add_flying_body(builder, "tetrahedra", random_filled_shape(Filled::tetrahedra, random), true, random);
  add_flying_body(builder, "balloon", random_filled_shape(Filled::balloon, random), true, random);
  RandomScene made = make_scene(builder, swing_above_floor(0.0, random), settings, random);
  made.kind = "three filled bodies";
  made.keeps_cells = true;
  return with_pin_in_some(std::move(made), builder, random);
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

/// Attachments join the bodies to each other and to an obstacle that swings above a floor. Rods give way to contact.
RandomScene attached(NetworkBuilder builder, bool rods_alone, const SimulatorSettings& settings, Random& random) {
  std::vector<Obstacle> obstacles = swing_above_floor(0.0, random);
  const SpringNetwork network = builder.build();
  for (int k = 0; k < 4; ++k) {
    Attachment attachment = random_attachment(network, static_cast<Index>(obstacles.size()), random);
    attachment.name = "attachment " + std::to_string(k);
    if (rods_alone) attachment.stiffness.reset();
    builder.add_attachment(std::move(attachment));
  }
  RandomScene made = make_scene(builder, std::move(obstacles), settings, random);
  made.kind = rods_alone ? "a lattice and bends with rods" : "attached bodies";
  return with_pin_in_some(std::move(made), builder, random);
}

RandomScene scene_of_attached(const SimulatorSettings& settings, Random& random) {
  return attached(three_bodies(random), false, settings, random);
}

/// A lattice of a coarse mesh, and two ropes, cloths or meshes that resist bending.
RandomScene scene_of_rods(const SimulatorSettings& settings, Random& random) {
  NetworkBuilder builder;
  add_flying_body(builder, "lattice", random_filled_shape(Filled::coarse_lattice, random), true, random);
  add_flying_body(builder, "first", random_bent_shape(random), true, random);
  add_flying_body(builder, "second", random_bent_shape(random), true, random);
  return attached(std::move(builder), true, settings, random);
}

/// Bodies fall beside each other on a floor and sleep. Later an obstacle comes and wakes some of them.
RandomScene scene_that_sleeps(SimulatorSettings settings, Random& random) {
  NetworkBuilder builder;
  constexpr double kFall = 1.2;  // [s]
  const std::vector<Obstacle> obstacles = swing_above_floor(kFall, random);
  const double floor = std::get<HalfSpaceGeometry>(obstacles.back().geometry).offset;
  const Index bodies = 1 + random.below(3);
  for (Index k = 0; k < bodies; ++k) {
    RigidTransform pose = RigidTransform::Identity();
    const double turn = random.between(0.0, 360.0);
    pose.linear() = rotation_from_degrees(random.below(2) == 0 ? Vector3(90.0, turn, 0.0) : Vector3(0.0, turn, 0.0));
    pose.translation() = Vector3(random.between(-1.0, 1.0), floor + random.between(0.05, 0.6), random.between(-1.0, 1.0));
    add_body(builder, "body " + std::to_string(k), random_shape(random), pose, Vector3::Zero(), true, random);
  }
  settings.step = one_of(random, {1.0 / 240.0, 1.0 / 60.0});
  settings.sleep = true;
  RandomScene made = make_scene(builder, obstacles, settings, random);
  made.scene.frames = 1 + static_cast<int>((kFall + 1.0) / made.scene.settings.step);
  made.kind = "bodies that sleep";
  return with_pin_in_some(std::move(made), builder, random);
}

/// A scene of this kind, in [0, kKinds); kinds that run for long are rare.
constexpr Index kKinds = 40;
std::optional<RandomScene> draw(Index kind, const IntegratorSettings& integrator, Random& random) {
  const SimulatorSettings settings = random_settings(integrator, random);
  if (kind < 8) return scene_of_one(settings, random);
  if (kind < 14) return scene_of_three(settings, random);
  if (kind < 20) return scene_above_floor(settings, random);
  if (kind < 24) return scene_with_pin(false, settings, random);
  if (kind < 28) return scene_with_pin(true, settings, random);
  if (kind < 32) return scene_of_attached(settings, random);
  if (kind < 34) return scene_of_rods(settings, random);
  if (kind < 36) return scene_of_filled(settings, random);
  if (kind < 37) return scene_of_three_filled(settings, random);
  return scene_that_sleeps(settings, random);
}

/// Whether nothing intersects at the start.
bool can_start(const BuiltScene& scene) {
  try {
    const Simulator simulator(scene.network, scene.settings, scene.obstacles);
    return true;
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      if (problem.rule.find("at the start") == std::string::npos) throw;
    }
    return false;
  }
}

/// From numbers of their own, so that all else of a scene is as without them.
void draw_inner_substeps(std::uint64_t seed, SimulatorSettings& settings) {
  Random random(~seed);
  if (may_have_inner_substeps(settings)) settings.inner_substeps = std::array{1, 2, 4, 8}[random.below(4)];
}

}  // namespace

RandomScene random_scene(std::uint64_t seed, const IntegratorSettings& integrator) {
  Random random(6 * seed + integrator.index());
  const Index kind = random.below(kKinds);
  for (;;) {
    std::optional<RandomScene> made = draw(kind, integrator, random);
    if (!made || !can_start(made->scene)) continue;
    draw_inner_substeps(seed, made->scene.settings);
    return std::move(*made);
  }
}

bool must_not_diverge(const BuiltScene& scene) {
  SimulatorSettings settings = scene.settings;
  settings.stability = StabilityCheck::warn;
  return check_step(settings, simulation_bounds(scene.network, settings, true)).empty();
}

}  // namespace sprung::testing
