// Forces leave out elements of which all particles sleep, and no others.
#include "network/model/activity.h"

#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/forces/surface_air_force.h"
#include "network/network_builder.h"
#include "network/set_asleep.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace sprung {
namespace {

constexpr Index kSide = 6;

/// A cloth with springs and angle bends.
SpringNetwork cloth() {
  BodyShape shape =
      make_cloth({.size = {1.0, 1.0}, .resolution = {kSide, kSide}},
                 {.structural = SpringMaterial{.value = 10.0, .damping = 0.3}, .shear = SpringMaterial{.value = 5.0}});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  for (Index row = 0; row < kSide; ++row) {
    for (Index i = row * kSide; i < (row + 1) * kSide - 2; ++i) builder.add_angle_bend(i, i + 1, i + 2, 2.0, 0.1);
  }
  return builder.build();
}

TEST(SleepingParticles, AwakeOnesFeelTheSameForces) {
  const SpringNetwork awake = cloth();
  SpringNetwork half_asleep = awake;
  std::vector<char> asleep(kSide * kSide, 0);
  for (std::size_t i = 0; i < asleep.size(); ++i) asleep[i] = i % kSide < kSide / 2 ? 1 : 0;
  set_asleep(asleep, half_asleep);

  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.05, 0.05);
  const Points x = awake.positions + Points::NullaryExpr(3, awake.particle_count(), [&]() { return unit(random); });
  const Points v = Points::NullaryExpr(3, awake.particle_count(), [&]() { return unit(random); });
  const auto forces_of = [&](const SpringNetwork& network) {
    std::vector<Points> forces(3, Points::Zero(3, x.cols()));
    const Kinematics at{.x = x, .v = v};
    SpringForce(network).add(at, forces[0]);
    BendingAngleForce(network).add(at, forces[1]);
    SurfaceAirForce(network, {.normal = 0.5, .tangential = 0.1}, Wind(), 9.81, 0.0).add(at, forces[2]);
    return forces;
  };
  const std::vector<Points> expected = forces_of(awake);
  const std::vector<Points> found = forces_of(half_asleep);
  for (std::size_t force = 0; force < found.size(); ++force) {
    Index skipped = 0;
    for (Index i = 0; i < x.cols(); ++i) {
      if (half_asleep.is_asleep(i)) {
        skipped += found[force].col(i) != expected[force].col(i) ? 1 : 0;
      } else {
        EXPECT_LT((found[force].col(i) - expected[force].col(i)).norm(), 1.0e-12) << "force " << force << ", particle " << i;
      }
    }
    EXPECT_GT(skipped, 0) << "force " << force;
  }
}

}  // namespace
}  // namespace sprung
