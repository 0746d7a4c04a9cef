#include "simulation/monitoring/energy_watch.h"

#include "network/network_builder.h"
#include "simulation/model/force_factory.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

/// One particle of 2 kg, without springs.
SpringNetwork one_particle() {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 2.0);
  return builder.build();
}

/// Two particles of 1 kg, 1 m apart, with a spring between them.
SpringNetwork two_masses(double stiffness, double rest_length) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_particle(Vector3::UnitX(), 1.0);
  builder.add_spring(0, 1, stiffness, rest_length);
  return builder.build();
}

/// A watch with the memory of one run.
class WatchedRun {
 public:
  WatchedRun(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles,
             const Forces& forces)
      : watch_(network, settings, obstacles, forces) {}

  /// Step 0 is the start.
  void note(std::int64_t step, const Energies& energies) {
    step == 0 ? EnergyWatch::note_change(energies, memory_) : EnergyWatch::note(step, energies, memory_);
  }
  void note_pin(double speed) { EnergyWatch::note_pin(speed, memory_); }
  void note_obstacle(double speed) { watch_.note_obstacle(speed, memory_); }
  [[nodiscard]] bool explosion(const Energies& energies) const { return watch_.explosion(energies, memory_).has_value(); }

 private:
  EnergyWatch watch_;
  EnergyMemory memory_;
};

WatchedRun watch(const SpringNetwork& network) {
  const SimulatorSettings settings{.step = 0.01};
  return {network, settings, {}, network_forces(network, settings)};
}

TEST(EnergyWatch, AllowsAThousandTimesTheInitialKineticEnergy) {
  WatchedRun energy = watch(one_particle());
  energy.note(0, {.kinetic = 1.0});
  EXPECT_FALSE(energy.explosion({.kinetic = 999.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 1001.0}));
  // Limits and contact may accelerate the network in its first steps. Later kinetic energy does not count as initial.
  energy.note(1, {.kinetic = 2.0});
  energy.note(64, {.kinetic = 1500.0});
  EXPECT_FALSE(energy.explosion({.kinetic = 1999.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 2001.0}));
}

TEST(EnergyWatch, ALiftedBodyMayFall) {
  WatchedRun energy = watch(one_particle());
  energy.note(0, {.gravity = -3.0});
  energy.note(64, {.gravity = 1.0});
  energy.note(128, {.gravity = 0.5});
  EXPECT_FALSE(energy.explosion({.kinetic = 3999.0, .gravity = -3.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 4001.0, .gravity = -3.0}));
}

// A change of gravity moves the zero of the potential energy, so that what was released before does not count.
TEST(EnergyWatch, AChangeMayBringEnergy) {
  WatchedRun energy = watch(one_particle());
  energy.note(0, {.gravity = 5.0});
  energy.note(0, {.elastic = 2.0, .gravity = -5.0});
  EXPECT_FALSE(energy.explosion({.kinetic = 1999.0, .gravity = -5.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 4001.0, .gravity = -5.0}));
}

// 1/2 m v^2 = 9 J.
TEST(EnergyWatch, EveryParticleMayMoveAsFastAsThePins) {
  WatchedRun energy = watch(one_particle());
  energy.note(0, {});
  energy.note_pin(3.0);
  energy.note_pin(2.0);
  EXPECT_FALSE(energy.explosion({.kinetic = 8999.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 9001.0}));
}

// 1/2 m v^2 = 9 J. A wedge drives a particle at up to 32 times that speed: 1,024 times the energy. A restitution of 1/2 allows
// three times that speed: nine times the energy.
TEST(EnergyWatch, EveryParticleMayMoveAsFastAsObstaclesDriveIt) {
  const SpringNetwork network = one_particle();
  Obstacle obstacle{.name = "wall", .geometry = HalfSpaceGeometry{}};
  WatchedRun hard(network, {.step = 0.01}, {obstacle}, {});
  obstacle.material.restitution = 0.5;
  WatchedRun bouncing(network, {.step = 0.01}, {obstacle}, {});
  obstacle.material.restitution = 1.0;
  WatchedRun lossless(network, {.step = 0.01}, {obstacle}, {});
  for (WatchedRun* energy : {&hard, &bouncing, &lossless}) {
    energy->note(0, {.kinetic = 1.0e-6});
    energy->note_obstacle(0.0);
    EXPECT_TRUE(energy->explosion({.kinetic = 1.0}));
    energy->note_obstacle(3.0);
  }
  EXPECT_FALSE(hard.explosion({.kinetic = 1024.0 * 8999.0}));
  EXPECT_TRUE(hard.explosion({.kinetic = 1024.0 * 9001.0}));
  EXPECT_FALSE(bouncing.explosion({.kinetic = 1024.0 * 80999.0}));
  EXPECT_TRUE(bouncing.explosion({.kinetic = 1024.0 * 81001.0}));
  EXPECT_FALSE(lossless.explosion({.kinetic = 1.0e300}));
}

// 1/2 k d^2 = 4 J.
TEST(EnergyWatch, EverySpringMayBeStretchedToTwiceItsLength) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_particle(Vector3::UnitX(), 1.0);
  builder.add_spring(0, 1, 2.0, 2.0);
  WatchedRun energy = watch(builder.build());
  energy.note(0, {});
  EXPECT_FALSE(energy.explosion({.kinetic = 2000.0, .elastic = 1999.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 2000.0, .elastic = 2001.0}));
}

// The springs' capacity is 1/2 J, the stored energy 100 J.
TEST(EnergyWatch, ASlowlyStretchedSpringMaySnap) {
  const SpringNetwork network = two_masses(1.0, 1.0);
  WatchedRun slow = watch(network);
  WatchedRun fast = watch(network);
  for (WatchedRun* energy : {&slow, &fast}) energy->note(0, {});
  slow.note(64, {.kinetic = 0.9, .elastic = 100.0});
  fast.note(64, {.kinetic = 1.1, .elastic = 100.0});
  EXPECT_FALSE(slow.explosion({.kinetic = 100499.0}));
  EXPECT_TRUE(slow.explosion({.kinetic = 100501.0}));
  EXPECT_FALSE(fast.explosion({.kinetic = 499.0}));
  EXPECT_TRUE(fast.explosion({.kinetic = 501.0}));
}

// 2 kg at 1 m with a step of 0.01 s: (2^-26 / 0.01)^2 = 2.2e-12 J.
TEST(EnergyWatch, RoundingIsNoExplosion) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::UnitX(), 2.0);
  WatchedRun energy = watch(builder.build());
  energy.note(0, {});
  EXPECT_FALSE(energy.explosion({.kinetic = 2.2e-9}));
  EXPECT_TRUE(energy.explosion({.kinetic = 2.3e-9}));
}

// m g d = 40 J.
TEST(EnergyWatch, AParticleAtItsStretchLimitMayBounceByTheLengthOfASpring) {
  const SpringNetwork network = two_masses(0.0, 2.0);
  const SimulatorSettings settings{.step = 0.01, .gravity = {0.0, -10.0, 0.0}, .stretch_limit = StretchLimitSettings{}};
  WatchedRun energy(network, settings, {}, network_forces(network, settings));
  energy.note(0, {});
  EXPECT_FALSE(energy.explosion({.kinetic = 39999.0}));
  EXPECT_TRUE(energy.explosion({.kinetic = 40001.0}));
}

}  // namespace
}  // namespace sprung
