// Bodies that start in obstacles are moved out before time 0, as the judge confirms, and the run continues from there.
#include "base/error.h"
#include "base/parallel.h"
#include "collision/sample_meshes.h"
#include "network/network_builder.h"
#include "scenarios/judge.h"
#include "simulation/simulator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace sprung::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kThickness = 0.002;  // [m]

const SpringMaterials kSprings{.structural = SpringMaterial{.value = 50.0, .damping = 0.01},
                               .shear = SpringMaterial{.value = 25.0, .damping = 0.005},
                               .bend = SpringMaterial{.value = 1.0}};

const Vector3 kLying(-90.0, 0.0, 0.0);

RigidTransform pose_at(const Vector3& position, const Vector3& degrees = Vector3::Zero()) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(degrees);
  pose.translation() = position;
  return pose;
}

SpringNetwork network_of(BodyShape shape, const RigidTransform& pose, const std::vector<Index>& pins = {}) {
  set_total_mass(shape, 0.2);
  place(shape, pose, Vector3(0.1, -0.2, 0.3));
  NetworkBuilder builder;
  builder.add_body("body", shape, {.thickness = kThickness});
  if (!pins.empty()) builder.pin(pins);
  return builder.build();
}

/// A cloth of 1 m and 21 x 21 particles, 5 cm apart.
BodyShape cloth() { return make_cloth({.size = {1.0, 1.0}, .resolution = {21, 21}}, kSprings); }

BodyShape cube() { return make_solid({.size = {0.4, 0.4, 0.4}, .resolution = {7, 7, 7}}, kSprings); }

BodyShape rope(const std::vector<Vector3>& points) {
  return make_rope({.points = points, .particles = 61, .length = {}}, kSprings);
}

BodyShape ring(double radius, double tube) { return make_mesh_body(test::polygons(test::torus(radius, tube, 40, 12)), kSprings); }

Obstacle obstacle(const ObstacleGeometry& geometry, const RigidTransform& rest_pose = RigidTransform::Identity()) {
  return {.name = "obstacle", .geometry = geometry, .rest_pose = rest_pose, .material = {.thickness = 0.001}};
}

MeshGeometry mesh_of(TriangleMesh mesh, bool closed) { return {std::make_shared<TriangleMesh>(std::move(mesh)), closed}; }

MeshGeometry waves() {
  return mesh_of(test::terrain(4, [](Index i, Index j) { return 0.05 * std::sin(i) * std::cos(2 * j); }), false);
}

SimulatorSettings pushing_out() {
  SimulatorSettings settings{.step = 4.0e-4};
  settings.contact.start = ContactSettings::Start::push_out;
  return settings;
}

void expect_free(const Simulator& simulator) {
  for (const Obstacle& in : simulator.obstacles()) {
    const auto judge = judge_of(in.geometry);
    const Points local = in.rest_pose.inverse() * simulator.positions();
    EXPECT_EQ(judge->count_inside(local), 0);
    EXPECT_EQ(judge->count_crossings(judged_elements(simulator.network()), local), 0);
  }
}

double least_distance(const Simulator& simulator, const Obstacle& from) {
  const auto judge = judge_of(from.geometry);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& x : simulator.positions().colwise()) least = std::min(least, judge->distance(from.rest_pose.inverse() * x));
  return least;
}

struct StartCase {
  std::string name;
  SpringNetwork network;
  Obstacle in;
  Index most_moved;  ///< the largest permitted number of moved particles
};

std::ostream& operator<<(std::ostream& stream, const StartCase& start) { return stream << start.name; }

/// The numbers of moved particles are measured ones plus a tenth.
std::vector<StartCase> starts() {
  const Obstacle ball = obstacle(SphereGeometry{0.3});
  const Obstacle bunny = obstacle(mesh_of(test::bunny(), true));
  const ConeGeometry spike{0.02, 0.6};
  const RigidTransform aside = pose_at({0.31, 0.0, 0.12});
  return {
      {"AFlatClothDipsIntoTheFloor", network_of(cloth(), pose_at({0, 0.03, 0}, {-87, 0, 0})),
       obstacle(HalfSpaceGeometry{Vector3::UnitY(), 0.02}), 185},
      {"AClothStandsDeepInTheFloor", network_of(cloth(), pose_at({0, 0.3, 0})), obstacle(HalfSpaceGeometry{Vector3::UnitY(), 0.0}),
       116},
      {"AClothTouchesABall", network_of(cloth(), pose_at({0, 0.28, 0}, kLying)), ball, 24},
      {"AClothIsCutByABall", network_of(cloth(), pose_at({0, 0.1, 0}, kLying)), ball, 112},
      {"ASpikeIsThroughAFace", network_of(cloth(), pose_at({0, 0, 0}, kLying)), obstacle(spike, aside), 13},
      {"ASpikeOfAMeshIsThroughAFace", network_of(cloth(), pose_at({0, 0, 0}, kLying)),
       obstacle(mesh_of(obstacle_mesh(spike, 0.0), true), aside), 13},
      {"ACornerIsThroughACloth", network_of(cloth(), pose_at({0, 0.47, 0}, kLying)),
       obstacle(mesh_of(obstacle_mesh(BoxGeometry{Vector3::Ones()}, 0.0), true), pose_at({0.6, 0.0, 0.6}, {20, 30, 10})), 44},
      {"ARingOfAMeshIsInACloth", network_of(cloth(), pose_at({0, 0.1, 0}, kLying)),
       obstacle(mesh_of(test::torus(0.3, 0.12, 40, 20), true)), 138},
      {"AClothIsAcrossOpenHills", network_of(cloth(), pose_at({0, 0, 0}, kLying)), obstacle(waves()), 94},
      {"AClothLiesInAnOpenSheet", network_of(cloth(), pose_at({0, 0, 0}, kLying)), obstacle(mesh_of(test::flat_sheet(4), false)),
       441},
      {"AnEarIsThroughACloth", network_of(cloth(), pose_at({0, 0.4, 0}, kLying)), bunny, 16},
      {"ACubeIsInTheBunny", network_of(cube(), pose_at({0, 0.45, 0})), bunny, 43},
      {"ARingIsTooTight", network_of(ring(0.32, 0.05), pose_at({0, 0, 0})), obstacle(CylinderGeometry{0.3, 4.0}), 220},
      {"OneEndOfARopeIsInACapsule", network_of(rope({Vector3(0.05, 0.1, 0.0), Vector3(0.5, 2.0, 0.0)}), pose_at({0, 0, 0})),
       obstacle(CapsuleGeometry{0.2, 0.1}), 6},
  };
}

/// By which fraction the structural spring that is lengthened most is longer at `x` than in the network.
double lengthening(const SpringNetwork& network, const Points& x) {
  double most = 0.0;
  for (std::size_t s = 0; s < network.springs.kind.size(); ++s) {
    if (network.springs.kind[s] != SpringKind::structural) continue;
    const Index a = network.springs.first[s];
    const Index b = network.springs.second[s];
    const double before = (network.positions.col(a) - network.positions.col(b)).norm();
    most = std::max(most, (x.col(a) - x.col(b)).norm() / before - 1.0);
  }
  return most;
}

class EveryStart : public ::testing::TestWithParam<StartCase> {};

TEST_P(EveryStart, IsRefusedOrPushedOutAndContinues) {
  const auto& [name, network, in, most_moved] = GetParam();
  EXPECT_THROW(Simulator(network, {.step = 4.0e-4}, {in}), InputError);

  Simulator simulator(network, pushing_out(), {in});
  expect_free(simulator);
  EXPECT_EQ(simulator.state().v, network.velocities);
  EXPECT_THAT(simulator.notes(),
              ElementsAre(HasSubstr("body \"body\": intersected an obstacle or a body at the start and moved out: ")));
  if (lengthening(network, simulator.positions()) > 0.5) {
    EXPECT_THAT(simulator.warnings(), ElementsAre(HasSubstr(" % longer")));
  } else {
    EXPECT_THAT(simulator.warnings(), IsEmpty());
  }
  // The gap is the sum of both thicknesses; passes end within a thousandth of it.
  EXPECT_GE(least_distance(simulator, in), 0.998 * (kThickness + in.material.thickness));

  Index moved = 0;
  for (Index i = 0; i < network.particle_count(); ++i) moved += simulator.positions().col(i) != network.positions.col(i) ? 1 : 0;
  EXPECT_LE(moved, most_moved);
  EXPECT_GE(moved, 1);

  for (int step = 0; step < 50; ++step) simulator.step();
  expect_free(simulator);
}

INSTANTIATE_TEST_SUITE_P(StartScenario, EveryStart, ::testing::ValuesIn(starts()), [](const auto& of) { return of.param.name; });

TEST(StartScenario, ParticlesBelowTheFloorAreLiftedToTheirGapAndNoFarther) {
  const SpringNetwork network = network_of(cloth(), pose_at({0, 0.03, 0}, {-87, 0, 0}));
  const Simulator simulator(network, pushing_out(), {obstacle(HalfSpaceGeometry{Vector3::UnitY(), 0.02})});
  for (Index i = 0; i < network.particle_count(); ++i) {
    const Vector3 wanted = network.positions.col(i);
    const Vector3 expected(wanted.x(), std::max(wanted.y(), 0.02 + kThickness + 0.001), wanted.z());
    // The passes leave an error of a thousandth of the gap. The final solve leaves a millionth of a stride of 2.5 cm.
    EXPECT_NEAR((simulator.positions().col(i) - expected).norm(), 0.0, 4e-6) << i;
  }
}

TEST(StartScenario, AThinSheetLeavesABodyOnTheSideWhereMostOfItIs) {
  for (const double side : {-1.0, 1.0}) {
    const SpringNetwork network = network_of(cloth(), pose_at({0.2 * side, 0, 0}, kLying));
    const Obstacle wall = obstacle(mesh_of(test::flat_sheet(4), false), pose_at({0, 0, 0}, {0, 0, 90}));
    const Simulator simulator(network, pushing_out(), {wall});
    expect_free(simulator);
    EXPECT_GT((side * simulator.positions().row(0)).minCoeff(), 0.0);
  }
}

TEST(StartScenario, ARopeThroughATorusStaysInItsHole) {
  const SpringNetwork network =
      network_of(rope({Vector3(-0.9, 0.05, 0), Vector3(0, -0.14, 0.05), Vector3(0.9, 0.05, 0)}), pose_at({0, 0, 0}));
  const Obstacle torus = obstacle(mesh_of(test::torus(0.3, 0.12, 40, 20), true), pose_at({0, 0.1, 0}, {0, 0, 90}));
  const Simulator simulator(network, pushing_out(), {torus});
  expect_free(simulator);
  // The hole of radius 0.18 is in the plane x = 0.
  const Vector3 middle = simulator.positions().col(30);
  EXPECT_LT(std::abs(middle.x()), 0.05);
  EXPECT_LT(std::hypot(middle.y() - 0.1, middle.z()), 0.18);
}

TEST(StartScenario, SeveralBodiesArePushedOutOfSeveralObstacles) {
  NetworkBuilder builder;
  for (const double x : {-0.9, 0.6}) {
    BodyShape shape = cube();
    set_total_mass(shape, 0.2);
    place(shape, pose_at({x, 0.15, 0.0}, {10, 20, 30}), Vector3::Zero());
    builder.add_body(x < 0.0 ? "left" : "right", shape, {.thickness = kThickness});
  }
  Obstacle floor = obstacle(HalfSpaceGeometry{Vector3::UnitY(), 0.0});
  Obstacle wall = obstacle(BoxGeometry{Vector3(0.2, 2.0, 2.0)}, pose_at({-1.1, 0.0, 0.0}));
  floor.name = "floor";
  const Simulator simulator(builder.build(), pushing_out(), {floor, wall});
  expect_free(simulator);
  EXPECT_THAT(simulator.notes(), ElementsAre(HasSubstr("\"right\"")));
}

struct Placed {
  BodyShape shape;
  RigidTransform pose;
};

SpringNetwork network_of_several(const std::vector<Placed>& bodies) {
  NetworkBuilder builder;
  for (const Placed& body : bodies) {
    BodyShape shape = body.shape;
    set_total_mass(shape, 0.2);
    place(shape, body.pose, Vector3::Zero());
    builder.add_body("body" + std::to_string(&body - bodies.data()), shape, {.thickness = kThickness}, {.self = true});
  }
  return builder.build();
}

struct IntersectingCase {
  std::string name;
  std::vector<Placed> bodies;
};

std::ostream& operator<<(std::ostream& stream, const IntersectingCase& intersecting) { return stream << intersecting.name; }

class EveryIntersectingStart : public ::testing::TestWithParam<IntersectingCase> {};

TEST_P(EveryIntersectingStart, IsRefusedOrPushedApartAndContinues) {
  const SpringNetwork network = network_of_several(GetParam().bodies);
  const std::vector<Obstacle> floor = {obstacle(HalfSpaceGeometry{Vector3::UnitY(), 0.0})};
  const std::vector<JudgedElement> elements = judged_elements(network);
  EXPECT_GT(count_self_crossings(elements, network.positions), 0);
  EXPECT_THROW(Simulator(network, {.step = 4.0e-4}, floor), InputError);

  Simulator simulator(network, pushing_out(), floor);
  EXPECT_EQ(count_self_crossings(elements, simulator.positions()), 0);
  expect_free(simulator);
  const Body& first = network.bodies.front();
  EXPECT_EQ(simulator.positions().leftCols(first.particle_count), network.positions.leftCols(first.particle_count))
      << "the first body stays";
  // The others move by no more than the extent of the bodies.
  EXPECT_LT((simulator.positions() - network.positions).colwise().norm().maxCoeff(), 1.0);

  for (int step = 0; step < 50; ++step) simulator.step();
  EXPECT_EQ(count_self_crossings(elements, simulator.positions()), 0);
  expect_free(simulator);
}

INSTANTIATE_TEST_SUITE_P(
    StartScenario, EveryIntersectingStart,
    ::testing::Values(IntersectingCase{"ACubeIsInACube",
                                       {{cube(), pose_at({0, 0.3, 0})}, {cube(), pose_at({0.1, 0.5, 0.05}, {10, 20, 30})}}},
                      IntersectingCase{"TwoClothsCutEachOther",
                                       {{cloth(), pose_at({0, 0.6, 0}, kLying)}, {cloth(), pose_at({0.1, 0.62, 0}, {-80, 0, 0})}}},
                      IntersectingCase{"ThreeClothsCutEachOther",
                                       {{cloth(), pose_at({0, 0.6, 0}, kLying)},
                                        {cloth(), pose_at({0.1, 0.61, 0}, {-87, 5, 0})},
                                        {cloth(), pose_at({0.05, 0.63, 0.03}, {-92, 0, 3})}}},
                      IntersectingCase{"ARopeIsThroughACube",
                                       {{cube(), pose_at({0, 0.5, 0})},
                                        {rope({Vector3(-0.9, 0.55, 0.01), Vector3(0.9, 0.45, 0.02)}), pose_at({0, 0, 0})}}}),
    [](const auto& of) { return of.param.name; });

TEST(StartScenario, AClothPinnedAcrossAWallIsRefused) {
  const SpringNetwork network = network_of(cloth(), pose_at({0, 0, 0}, kLying), {0, 20, 420, 440});
  try {
    const Simulator simulator(network, pushing_out(), {obstacle(BoxGeometry{Vector3(0.1, 1e6, 1e6)})});
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("found no free position"), HasSubstr("intersects obstacle \"obstacle\"")));
  }
}

TEST(StartScenario, PinnedParticlesStay) {
  const SpringNetwork network = network_of(cloth(), pose_at({0, 0.1, 0}, kLying), {0, 20});
  const Simulator simulator(network, pushing_out(), {obstacle(SphereGeometry{0.3})});
  expect_free(simulator);
  EXPECT_EQ(simulator.positions().col(0), network.positions.col(0));
  EXPECT_EQ(simulator.positions().col(20), network.positions.col(20));
}

/// Start positions of the cloth that intersects a ball, with all lengths of the scene multiplied by `scale`.
Points scaled_start(double scale) {
  SpringNetwork network = network_of(cloth(), pose_at({0, 0.1, 0}, kLying));
  network.positions *= scale;
  network.bodies[0].material.thickness *= scale;
  for (double& length : network.springs.rest_length) length *= scale;
  Obstacle ball = obstacle(SphereGeometry{0.3 * scale});
  ball.material.thickness *= scale;
  return Simulator(network, pushing_out(), {ball}).positions();
}

TEST(StartScenario, ScalesToTheBitAndDoesNotDependOnThreads) {
  const Points expected = scaled_start(1.0);
  EXPECT_EQ(scaled_start(128.0), 128.0 * expected);
  EXPECT_EQ(scaled_start(1.0 / 128.0), expected / 128.0);
  const ThreadLimit one(1);
  EXPECT_EQ(scaled_start(1.0), expected);
}

}  // namespace
}  // namespace sprung::testing
