// Coulomb's law where a cloth meets many triangles at once, and others in each step: on a hill that is round.
#include "collision/sample_meshes.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace sprung {
namespace {

constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kThickness = 0.005;  // [m] of the cloth
constexpr double kBegin = 0.44;       // [rad] from the top, beyond what friction holds
constexpr double kSide = 0.1;         // [m] of the cloth

/// A hill of `radius` [m] about the z axis, of facets of 8 mm.
TriangleMesh round_hill(double radius) {
  constexpr double kFacet = 0.008;
  TriangleMesh mesh = test::flat_sheet(160);
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    const Vector3 p = kFacet * mesh.vertices.col(i);
    const double angle = kBegin + 0.2 / radius + p.x() / radius;
    mesh.vertices.col(i) = Vector3(radius * std::sin(angle), radius * std::cos(angle), p.z());
  }
  return mesh;
}

/// A square that lies on the hill, carried by the stretch limit alone.
SpringNetwork square(double radius, Index resolution, double friction) {
  const SpringMaterial without_force{};
  BodyShape shape =
      make_cloth({.size = {kSide, kSide}, .resolution = {resolution, resolution}}, {without_force, without_force, without_force});
  set_total_mass(shape, 0.02);
  RigidTransform pose = RigidTransform::Identity();
  pose.rotate(Eigen::AngleAxisd(-kBegin, Vector3::UnitZ()));
  pose.translate(Vector3(0.0, radius + kThickness, 0.0));
  pose.rotate(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3::UnitX()));
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("square", shape, {.thickness = kThickness, .friction = friction, .static_friction = friction});
  return builder.build();
}

/// How far [m] a point that slides on the hill of this radius gets: Coulomb's law with the weight that its speed leaves it.
double way_of_a_point(double radius, double friction, double duration) {
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
  Index resolution;  ///< particles along a side: of few the elements are what meets the hill
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

// Friction is right within a hundredth. The square is no point: that it bends and has a length may change its way by as much.
TEST_P(RoundHill, ASquareSlidesAsFarAsAPoint) {
  const auto& [radius, resolution, friction, steps_a_frame] = GetParam();
  constexpr int kFrames = 24;
  using enum SpringKind;
  Simulator simulator(
      square(radius, resolution, friction),
      {.step = 1.0 / (60.0 * steps_a_frame),
       .gravity = {0.0, -kGravity, 0.0},
       .stretch_limit = StretchLimitSettings{.max_stretch = 0.0, .kinds = {structural, shear, bend}, .iterations = 4}},
      {{.name = "hill",
        .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(round_hill(radius)), false},
        .material = {.friction = friction, .static_friction = friction}}});
  const auto angle = [&] {
    const Vector3 middle = simulator.positions().rowwise().mean();
    return std::atan2(middle.x(), middle.y());
  };
  const double begin = angle();
  for (int step = 0; step < kFrames * steps_a_frame; ++step) simulator.step();
  const double radius_of_middle = radius + kThickness;
  const auto way_with = [&](double mu) { return way_of_a_point(radius_of_middle, mu, kFrames / 60.0); };
  const double way = radius_of_middle * (angle() - begin);
  EXPECT_GT(way, 0.99 * way_with(1.01 * friction));
  EXPECT_LT(way, 1.01 * way_with(0.99 * friction));
}

}  // namespace
}  // namespace sprung
