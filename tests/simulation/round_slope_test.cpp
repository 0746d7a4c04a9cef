// A cloth slides over many triangles at once, and over others in each step: on round hills and in round valleys.
#include "collision/sample_meshes.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kThickness = 0.005;  // [m] of the cloth
constexpr double kBegin = 0.44;       // [rad] from the top, beyond the friction angle
constexpr double kSide = 0.1;         // [m] of the cloth

/// A section of a cylinder about the z axis that reaches `reach` [m] to each side of `middle` [rad]. The angle counts from the top
/// if the radius [m] is positive, otherwise from the bottom.
TriangleMesh round_slope(double radius, double middle, double reach, double facet) {
  TriangleMesh mesh = test::flat_sheet(2 * static_cast<Index>(reach / facet));
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    const Vector3 p = facet * mesh.vertices.col(i);
    const double angle = middle + p.x() / radius;
    mesh.vertices.col(i) = Vector3(std::abs(radius) * std::sin(angle), radius * std::cos(angle), p.z());
  }
  return mesh;
}

/// A square that lies `angle` [rad] from the top of a hill or from the bottom of a valley. The stretch limit alone keeps its
/// shape.
SpringNetwork square(double side, double radius, double angle, Index resolution, double friction) {
  const SpringMaterial without_force{};
  BodyShape shape =
      make_cloth({.size = {side, side}, .resolution = {resolution, resolution}}, {without_force, without_force, without_force});
  set_total_mass(shape, 0.02);
  const double sagitta = radius < 0.0 ? side * side / 8.0 / -radius : 0.0;
  RigidTransform pose = RigidTransform::Identity();
  pose.rotate(Eigen::AngleAxisd(radius < 0.0 ? angle : -angle, Vector3::UnitZ()));
  pose.translate(Vector3(0.0, radius + kThickness + sagitta, 0.0));
  pose.rotate(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3::UnitX()));
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("square", shape, {.thickness = kThickness, .friction = friction, .static_friction = friction});
  return builder.build();
}

Simulator simulator_of(SpringNetwork network, TriangleMesh slope, double friction, int steps_a_frame) {
  using enum SpringKind;
  const SimulatorSettings settings{
      .step = 1.0 / (60.0 * steps_a_frame),
      .gravity = {0.0, -kGravity, 0.0},
      .stretch_limit = StretchLimitSettings{.max_stretch = 0.0, .kinds = {structural, shear, bend}, .iterations = 4}};
  const Obstacle obstacle{.name = "slope",
                          .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(std::move(slope)), false},
                          .material = {.friction = friction, .static_friction = friction}};
  return Simulator(std::move(network), settings, {obstacle});
}

Vector3 middle_of(const Simulator& simulator) { return simulator.positions().rowwise().mean(); }

/// The distance [m] that a point slides on a hill of this radius: Coulomb's law with the weight that remains at its speed.
double distance_of_a_point(double radius, double friction, double duration) {
  constexpr double kFine = 1e-5;
  double angle = kBegin;
  double spin = 0.0;
  for (double t = 0.0; t < duration; t += kFine) {
    const double weight = std::max(0.0, kGravity / radius * std::cos(angle) - spin * spin);
    spin += (kGravity / radius * std::sin(angle) - friction * weight) * kFine;
    angle += spin * kFine;
  }
  return radius * (angle - kBegin);
}

struct Slide {
  double radius;     ///< of the hill [m]
  Index resolution;  ///< particles along a side; if they are few, elements touch the hill
  double friction;
  int steps_a_frame;
};

void PrintTo(const Slide& slide, std::ostream* stream) {
  *stream << slide.resolution << " squared on " << slide.radius << " m, friction " << slide.friction << ", " << slide.steps_a_frame
          << " steps";
}

class RoundHill : public ::testing::TestWithParam<Slide> {};
INSTANTIATE_TEST_SUITE_P(Slides, RoundHill,
                         ::testing::Values(Slide{1.0, 2, 0.3, 5}, Slide{1.0, 2, 0.3, 20}, Slide{1.0, 8, 0.3, 5},
                                           Slide{1.0, 8, 0.3, 20}, Slide{1.0, 8, 0.1, 5}, Slide{3.0, 8, 0.3, 5}));

// Friction is correct to one per cent, and the square slides like a point: its side is a tenth of the radius, so the mean of the
// slope's sine is off by (0.1 / 2)^2 / 6.
TEST_P(RoundHill, ASquareSlidesAsFarAsAPoint) {
  const auto& [radius, resolution, friction, steps_a_frame] = GetParam();
  constexpr int kFrames = 24;
  Simulator simulator = simulator_of(square(kSide, radius, kBegin, resolution, friction),
                                     round_slope(radius, kBegin + 0.2 / radius, 0.6, 0.008), friction, steps_a_frame);
  const auto angle = [&] { return std::atan2(middle_of(simulator).x(), middle_of(simulator).y()); };
  const double begin = angle();
  for (int step = 0; step < kFrames * steps_a_frame; ++step) simulator.step();
  const double radius_of_middle = radius + kThickness;
  const auto distance_with = [&](double mu) { return distance_of_a_point(radius_of_middle, mu, kFrames / 60.0); };
  const double distance = radius_of_middle * (angle() - begin);
  EXPECT_GT(distance, 0.999 * distance_with(1.01 * friction));
  EXPECT_LT(distance, 1.001 * distance_with(0.99 * friction));
}

struct Swing {
  double facet;  ///< [m]
  double side;   ///< of the square [m]
  double start;  ///< from the bottom [rad]
  Index resolution;
  int steps_a_frame;
};

void PrintTo(const Swing& swing, std::ostream* stream) {
  *stream << swing.side << " m, " << swing.resolution << " squared over facets of " << swing.facet << " m, " << swing.steps_a_frame
          << " steps";
}

class RoundValley : public ::testing::TestWithParam<Swing> {};
INSTANTIATE_TEST_SUITE_P(Swings, RoundValley,
                         ::testing::Values(Swing{0.01, kSide, 0.5, 2, 5}, Swing{0.003, kSide, 0.5, 8, 5},
                                           Swing{0.01, kSide, 0.5, 8, 20}, Swing{0.0125, 0.3, 0.7, 3, 4}));

// A straight step enters the valley, and contact removes that component of the velocity. The square rises by 2 % of the angle less
// with steps of 1/300 s, and by 0.8 % less with steps of a quarter of that. Twice the larger value is allowed.
TEST_P(RoundValley, AFrictionlessSquareRisesToItsStartingHeight) {
  const auto& [facet, side, start, resolution, steps_a_frame] = GetParam();
  constexpr double kRadius = 1.0;
  Simulator simulator = simulator_of(square(side, -kRadius, -start, resolution, 0.0),
                                     round_slope(-kRadius, 0.0, start + 0.25, facet), 0.0, steps_a_frame);
  double highest = -start;
  for (int step = 0; step < 75 * steps_a_frame; ++step) {
    simulator.step();
    highest = std::max(highest, std::atan2(middle_of(simulator).x(), -middle_of(simulator).y()));
  }
  EXPECT_NEAR(highest, start, 0.04 * start);
}

}  // namespace
}  // namespace sprung
