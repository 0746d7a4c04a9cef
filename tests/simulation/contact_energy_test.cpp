// Contact takes energy or leaves it, in steps of any size.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

using testing::kGravity;

constexpr double kMass = 0.2;
constexpr double kStiffness = 100.0;
constexpr double kThickness = 0.01;

/// A cloth of 1 m and 3 x 3 particles, askew, a little above a ball, which an edge and a corner of it meet at once.
SpringNetwork cloth_askew(double height) {
  const SpringMaterial spring{.value = kStiffness};
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {3, 3}}, {.structural = spring, .shear = spring, .bend = spring});
  set_total_mass(shape, kMass);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-80.0, 10.0, 0.0});
  pose.translation() = Vector3(0.0, height, 0.0);
  place(shape, pose, Vector3::Zero());
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = kThickness});
  return builder.build();
}

// What contact pushes out of the gap is then higher, and springs are longer, by half of the gap at most, which is what truncation
// leaves of it: of a particle with eight springs. Speeds lag behind by half a step.
TEST(ContactEnergy, ContactMakesNoneInSmallSteps) {
  const SpringNetwork network = cloth_askew(0.25);
  const Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.2}};
  const double deep = 0.5 * kThickness;
  const double pushed = kMass / 9.0 * kGravity * deep + 8.0 * 0.5 * kStiffness * deep * deep;
  for (const int parts : {5, 1000, 6000}) {
    const double step = 1.0 / (60.0 * parts);
    Simulator simulator(network, {.step = step, .integrator = VerletSettings{}}, {ball});
    const auto energy = [&] {
      const double motion = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose());
      return motion + simulator.elastic_energy() + simulator.gravity_energy();
    };
    const double begin = energy();
    const double lag = kMass * kGravity * std::sqrt(2.0 * kGravity * 0.25) * step / 2.0;
    double most = 0.0;
    for (double time = 0.0; time < 0.35; time += step) {
      simulator.step();
      most = std::max(most, energy() - begin);
    }
    EXPECT_LT(most, pushed + lag) << parts;
  }
}

}  // namespace
}  // namespace sprung
