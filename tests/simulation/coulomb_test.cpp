// Coulomb's law for each scheme: a body slides where the slope exceeds its friction angle, with the acceleration of a block.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <ostream>
#include <variant>
#include <vector>

namespace sprung {
namespace {

constexpr double kFriction = 0.4;
constexpr double kThickness = 0.005;  // [m]
constexpr double kSide = 0.2;         // [m] of the body
constexpr double kLayer = 0.04;       // [m] of a solid
constexpr ContactMaterial kRough{.thickness = kThickness, .friction = kFriction, .static_friction = kFriction};

SpringMaterial elastic(double modulus) {
  SpringMaterial material{.value = modulus};
  material.measure = SpringMaterial::Measure::modulus;
  material.damping_ratio = 0.2;
  return material;
}

/// A body around the origin, level, whose lowest particles have y = 0: a rope (-1 layers), a cloth (0) or a solid.
BodyShape level_body(Index layers) {
  RigidTransform pose = RigidTransform::Identity();
  BodyShape shape;
  if (layers < 0) {
    shape = make_rope({.points = {{-0.5 * kSide, 0.0, 0.0}, {0.5 * kSide, 0.0, 0.0}}, .particles = 7, .length = {}},
                      {.structural = elastic(1.0e2)});
    set_density(shape, 0.1);
  } else if (layers == 0) {
    shape = make_cloth({.size = {kSide, kSide}, .resolution = {4, 4}}, {.structural = elastic(1.0e3), .shear = elastic(5.0e2)});
    set_density(shape, 0.3);
    pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  } else {
    const double height = kLayer * static_cast<double>(layers);
    shape = make_solid({.size = {kSide, height, kSide}, .resolution = {3, layers + 1, 3}},
                       {.structural = elastic(1.0e5), .shear = elastic(5.0e4)});
    set_density(shape, 500.0);
    pose.translation().y() = 0.5 * height;
  }
  place(shape, pose, Vector3::Zero());
  return shape;
}

struct Slide {
  IntegratorSettings scheme;
  Index layers;
};

void PrintTo(const Slide& slide, std::ostream* stream) {
  *stream << "scheme " << slide.scheme.index() << ", " << slide.layers << " layers";
}

/// All schemes but explicit Euler, which adds energy in each step.
std::vector<Slide> slides() {
  std::vector<Slide> result;
  for (const IntegratorSettings& scheme : all_integrators()) {
    if (std::holds_alternative<ExplicitEulerSettings>(scheme)) continue;
    for (const Index layers : {-1, 0, 1, 2, 3, 5}) result.push_back({scheme, layers});
  }
  return result;
}

/// A body on a slope that goes down towards -x. Explicit schemes need steps for the springs of the solid.
Simulator simulator_of(const Slide& slide, double angle) {
  BodyShape shape = level_body(slide.layers);
  RigidTransform pose = RigidTransform::Identity();
  pose.rotate(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  pose.translate(Vector3(0.0, kThickness, 0.0));
  place(shape, pose, Vector3::Zero());
  NetworkBuilder builder;
  builder.add_body("body", shape, kRough);
  const double step = std::holds_alternative<ImplicitEulerSettings>(slide.scheme) ? 1.0 / 240.0 : 1.0 / 1920.0;
  return Simulator(builder.build(), {.step = step, .integrator = slide.scheme, .sleep = false},
                   {testing::ground({.friction = kFriction, .static_friction = kFriction}, angle)});
}

/// The position of the centre of mass down the slope [m].
double distance_down(const Simulator& simulator, double angle) {
  const Vector3 moment = simulator.positions() * simulator.network().masses;
  return moment.dot(Vector3(-std::cos(angle), -std::sin(angle), 0.0)) / simulator.network().masses.sum();
}

/// The distances [m] in two periods of `seconds` after the first one.
std::array<double, 2> distances(Simulator& simulator, double angle, double seconds) {
  std::array<double, 3> at{};
  for (double& distance : at) {
    testing::run(simulator, seconds);
    distance = distance_down(simulator, angle);
  }
  return {at[1] - at[0], at[2] - at[1]};
}

class Coulomb : public ::testing::TestWithParam<Slide> {};
INSTANTIATE_TEST_SUITE_P(Slides, Coulomb, ::testing::ValuesIn(slides()));

// The body begins undeformed and slides while it bounces on its springs. Then it rocks in place: the tolerance is a hundredth of
// what it would slide with 4 % less friction.
TEST_P(Coulomb, ABodyStopsTwoPerCentBelowTheFrictionAngle) {
  const double angle = std::atan(0.98 * kFriction);
  Simulator simulator = simulator_of(GetParam(), angle);
  const double sliding = 0.5 * testing::kGravity * 0.02 * kFriction * std::cos(angle);
  EXPECT_NEAR(distances(simulator, angle, 1.0)[1], 0.0, 0.01 * sliding);
}

TEST_P(Coulomb, ABodySlidesTwoPerCentBeyondTheFrictionAngle) {
  const double angle = std::atan(1.02 * kFriction);
  Simulator simulator = simulator_of(GetParam(), angle);
  const auto [first, second] = distances(simulator, angle, 0.5);
  EXPECT_GT(first, 0.0);
  EXPECT_GT(second, first);
}

// With a constant acceleration a, a period T adds a T^2 to the distance in the period before.
TEST_P(Coulomb, ABodyAcceleratesLikeABlockOnASteepSlope) {
  const double angle = std::atan(1.5 * kFriction);
  Simulator simulator = simulator_of(GetParam(), angle);
  const auto [first, second] = distances(simulator, angle, 0.5);
  const double expected = testing::kGravity * (std::sin(angle) - kFriction * std::cos(angle));
  EXPECT_NEAR((second - first) / 0.25, expected, 0.02 * expected);
}

constexpr double kPlankHeight = 0.05;  // [m]

/// A body on a long plank, which is a body of the network too. The plank's underside is pinned, and gravity inclines instead of it,
/// towards +x.
Simulator on_plank(const Slide& slide, double angle) {
  NetworkBuilder builder;
  BodyShape plank = make_solid({.size = {1.8, kPlankHeight, 0.6}, .resolution = {10, 2, 4}},
                               {.structural = elastic(1.0e5), .shear = elastic(5.0e4)});
  set_density(plank, 500.0);
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Vector3(0.5, -0.5 * kPlankHeight, 0.0);
  place(plank, pose, Vector3::Zero());
  const Index first = builder.add_body("plank", plank, kRough);
  for (std::size_t i = 0; i < plank.positions.size(); ++i) {
    if (plank.positions[i].y() < -0.5 * kPlankHeight) builder.pin(first + static_cast<Index>(i));
  }
  BodyShape body = level_body(slide.layers);
  pose.translation() = Vector3(0.013, kThickness, 0.017);
  place(body, pose, Vector3::Zero());
  builder.add_body("body", body, kRough);
  const double step = std::holds_alternative<ImplicitEulerSettings>(slide.scheme) ? 1.0 / 240.0 : 1.0 / 1920.0;
  return Simulator(builder.build(), {.step = step,
                                     .gravity = testing::kGravity * Vector3(std::sin(angle), -std::cos(angle), 0.0),
                                     .integrator = slide.scheme,
                                     .sleep = false});
}

/// As `distances`, of the body on a plank.
std::array<double, 2> distances_on_plank(Simulator& simulator, double seconds) {
  const Body& body = simulator.network().bodies.back();
  std::array<double, 3> at{};
  for (double& distance : at) {
    testing::run(simulator, seconds);
    distance = simulator.positions().row(0).tail(body.particle_count).mean();
  }
  return {at[1] - at[0], at[2] - at[1]};
}

// It may creep by a hundredth of what it would slide without friction. With implicit Euler it creeps by less than a micrometre.
TEST_P(Coulomb, ABodyRestsOnAnotherBelowTheFrictionAngle) {
  const double angle = std::atan(0.75 * kFriction);
  Simulator simulator = on_plank(GetParam(), angle);
  EXPECT_NEAR(distances_on_plank(simulator, 0.5)[1], 0.0, 0.01 * 0.5 * testing::kGravity * std::sin(angle) * 0.25);
}

TEST_P(Coulomb, ABodyAcceleratesLikeABlockOnAnother) {
  const double angle = std::atan(1.5 * kFriction);
  Simulator simulator = on_plank(GetParam(), angle);
  const auto [first, second] = distances_on_plank(simulator, 0.25);
  const double expected = testing::kGravity * (std::sin(angle) - kFriction * std::cos(angle));
  EXPECT_NEAR((second - first) / 0.0625, expected, 0.02 * expected);
}

/// A box beside a solid of one layer, that moves towards it by 2 mm in a tenth of a second.
Obstacle jaw(const char* name, double side) {
  Obstacle result{.name = name,
                  .geometry = BoxGeometry{.size = {0.1, 0.1, 0.4}},
                  .motion = {.keyframes = {{.time = 0.0}, {.time = 0.1, .position = {-0.002 * side, 0.0, 0.0}}}},
                  .material = {.friction = kFriction, .static_friction = kFriction}};
  result.rest_pose.translation() = Vector3(side * (0.5 * kSide + kThickness + 0.05), 0.5 * kLayer, 0.0);
  return result;
}

class Grip : public ::testing::TestWithParam<IntegratorSettings> {};
INSTANTIATE_TEST_SUITE_P(Schemes, Grip, ::testing::Values(VerletSettings{}, ImplicitEulerSettings{}));

// Springs of a side of 0.2 m x 0.04 m that are 2 % shorter press with 16 N. Two sides with friction 0.4 carry 12.8 N; the weight is
// 7.8 N.
TEST_P(Grip, TwoJawsCarryABlock) {
  NetworkBuilder builder;
  builder.add_body("block", level_body(1), kRough);
  const double step = std::holds_alternative<ImplicitEulerSettings>(GetParam()) ? 1.0 / 240.0 : 1.0 / 1920.0;
  Simulator simulator(builder.build(), {.step = step, .integrator = GetParam(), .sleep = false},
                      {jaw("left", -1.0), jaw("right", 1.0)});
  testing::run(simulator, 2.0);  // it settles by 0.01 mm in the second half
  const double height = simulator.positions().row(1).mean();
  EXPECT_GT(height, -0.1 * kSide);
  testing::run(simulator, 1.0);
  EXPECT_NEAR(simulator.positions().row(1).mean(), height, 1.0e-5);
}

// The same with jaws that are bodies of the network. Their corners and edges press into the block's sides between its particles.
TEST_P(Grip, TwoBodiesCarryABlock) {
  NetworkBuilder builder;
  for (const double side : {-1.0, 1.0}) {
    BodyShape shape =
        make_solid({.size = {0.1, 0.1, 0.4}, .resolution = {2, 2, 3}}, {.structural = elastic(1.0e5), .shear = elastic(5.0e4)});
    set_density(shape, 500.0);
    const Obstacle model = jaw("jaw", side);
    place(shape, model.rest_pose, Vector3::Zero());
    const Index first = builder.add_body(side < 0.0 ? "left" : "right", shape, kRough);
    std::vector<Index> all(shape.positions.size());
    std::iota(all.begin(), all.end(), first);
    builder.pin(all, model.motion);
  }
  builder.add_body("block", level_body(1), kRough);
  const double step = std::holds_alternative<ImplicitEulerSettings>(GetParam()) ? 1.0 / 240.0 : 1.0 / 1920.0;
  Simulator simulator(builder.build(), {.step = step, .integrator = GetParam(), .sleep = false});
  const auto height = [&] { return simulator.positions().row(1).tail(simulator.network().bodies.back().particle_count).mean(); };
  testing::run(simulator, 1.0);
  const double begin = height();
  EXPECT_GT(begin, -0.1 * kSide);
  testing::run(simulator, 1.0);
  EXPECT_NEAR(height(), begin, 1.0e-4);
}

}  // namespace
}  // namespace sprung
