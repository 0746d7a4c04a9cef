#include "dynamics/stretch_limit/stretch_limit.h"

#include "base/parallel.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

namespace sprung {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
const std::vector<SpringKind> kAllKinds{SpringKind::structural, SpringKind::shear, SpringKind::bend};

double length_of(const Points& x, Index a, Index b) { return (x.col(a) - x.col(b)).norm(); }

/// The largest excess, spring by spring.
double excess_by_hand(const SpringNetwork& network, const StretchLimitSettings& settings, const Points& x) {
  double excess = 0.0;
  const Springs& springs = network.springs;
  for (Index k = 0; k < springs.count(); ++k) {
    if (std::ranges::find(settings.kinds, springs.kind[k]) == settings.kinds.end()) continue;
    if (network.is_fixed(springs.first[k]) && network.is_fixed(springs.second[k])) continue;
    const double relative = length_of(x, springs.first[k], springs.second[k]) / springs.rest_length[k];
    excess = std::max({excess, relative - 1.0 - settings.max_stretch, 1.0 - settings.max_compression - relative});
  }
  return excess;
}

TEST(StretchLimit, ProjectsOneSpringOntoItsLimit) {
  const SpringNetwork network = make_pair(3.0, 0.0, 2.0);
  const StretchLimit limit(network, {.max_stretch = 0.1});
  Points x = network.positions;
  EXPECT_NEAR(limit.project(network.positions, x), 3.0 / 2.0 - 1.1, 8 * kEpsilon);
  EXPECT_NEAR(length_of(x, 0, 1), 2.2, 8 * kEpsilon);
  EXPECT_NEAR(x(0, 0), 0.4, 8 * kEpsilon) << "equal masses share the correction";
}

TEST(StretchLimit, ProjectsACompressedSpringOntoItsLimit) {
  const SpringNetwork network = make_pair(1.0, 0.0, 2.0);
  const StretchLimit limit(network, {.max_stretch = 0.1, .max_compression = 0.25});
  Points x = network.positions;
  EXPECT_NEAR(limit.project(network.positions, x), 0.25, 8 * kEpsilon);
  EXPECT_NEAR(length_of(x, 0, 1), 1.5, 8 * kEpsilon);
}

// A push along the present direction would speed up a rotating spring.
TEST(StretchLimit, PushesAlongTheDirectionAtTheBeginningOfTheStep) {
  const SpringNetwork network = make_pair(2.0, 0.0, 2.0);
  const StretchLimit limit(network, {.max_compression = 0.0});
  const double angle = 0.25;
  const Vector3 turned = 1.9 * Vector3(std::cos(angle), std::sin(angle), 0.0);
  Points x = network.positions;
  x.col(1) = turned;
  limit.project(network.positions, x);
  EXPECT_GT(x(0, 1), turned.x());
  EXPECT_EQ(x(1, 1), turned.y());
  // The correction, a twentieth of the length, is scaled by the former length, which is a twentieth longer: a second-order error.
  EXPECT_NEAR(length_of(x, 0, 1), 2.0, 2.0 * 0.05 * 0.05);
}

TEST(StretchLimit, RelaxationMultipliesCorrections) {
  const SpringNetwork network = make_pair(3.0, 0.0, 2.0);
  const StretchLimit limit(network, {.max_stretch = 0.1});
  for (const double relaxation : {0.5, 1.5}) {
    Points x = network.positions;
    EXPECT_NEAR(limit.project(network.positions, x, relaxation), 3.0 / 2.0 - 1.1, 8 * kEpsilon);
    EXPECT_NEAR(length_of(x, 0, 1), 3.0 - relaxation * (3.0 - 2.2), 8 * kEpsilon);
  }
}

TEST(StretchLimit, RelaxationOfLessThanTwoConverges) {
  // A free cloth stretched by a half in one direction.
  SpringNetwork network = make_test_cloth(12, 0.0, 0.0, false);
  network.positions.row(0) *= 1.5;
  const StretchLimit limit(network, {.max_stretch = 0.02});
  const auto passes_to_reach = [&](double relaxation) {
    Points x = network.positions;
    int passes = 0;
    while (limit.project(network.positions, x, relaxation) > 1.0e-6 && passes < 2000) ++passes;
    return passes;
  };
  const int unrelaxed = passes_to_reach(1.0);
  EXPECT_LT(unrelaxed, 2000);
  EXPECT_LT(passes_to_reach(1.5), unrelaxed);
  EXPECT_LT(passes_to_reach(1.9), unrelaxed);
}

TEST(StretchLimit, LeavesSpringsWithinTheirLimitsUnchanged) {
  const SpringNetwork network = make_pair(2.1, 0.0, 2.0);
  const StretchLimit limit(network, {.max_stretch = 0.1});
  Points x = network.positions;
  EXPECT_EQ(limit.project(network.positions, x), 0.0);
  EXPECT_EQ(x, network.positions);
}

TEST(StretchLimit, WeighsEndsByInverseMass) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 3.0);
  builder.add_particle(Vector3(2.0, 0.0, 0.0), 1.0);
  builder.add_spring(0, 1, 0.0, 1.0);
  const SpringNetwork network = builder.build();
  Points x = network.positions;
  StretchLimit(network, {.max_stretch = 0.0}).project(network.positions, x);
  EXPECT_NEAR(x(0, 0), 0.25, 4 * kEpsilon);
  EXPECT_NEAR(x(0, 1), 1.25, 4 * kEpsilon);
}

// Springs between two rows share no particle. Each is projected as if it were alone, whether it is in a run or not.
TEST(StretchLimit, ProjectsEachOfManySpringsByItsOwnConstants) {
  constexpr Index kRow = 203;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.1, 1.0);
  const auto vector = [&] { return Vector3(unit(random), unit(random), unit(random)); };
  for (const bool same : {false, true}) {
    NetworkBuilder builder;
    for (Index i = 0; i < 2 * kRow; ++i) {
      const Vector3 position = vector();
      builder.add_particle(position, same ? 1.0 : unit(random));
    }
    for (Index i = 0; i < kRow; ++i) builder.add_spring(i, kRow + i, 0.0, same ? 0.5 : unit(random));
    const SpringNetwork network = builder.build();
    const StretchLimitSettings settings{.max_stretch = 0.1, .max_compression = 0.2};
    const StretchLimit limit(network, settings);
    Points x = network.positions;
    EXPECT_NEAR(limit.project(network.positions, x), excess_by_hand(network, settings, network.positions), 16 * kEpsilon);
    for (Index i = 0; i < kRow; ++i) {
      const Vector3 between = network.positions.col(kRow + i) - network.positions.col(i);
      const double rest_length = network.springs.rest_length[i];
      const double wanted = std::clamp(between.norm(), 0.8 * rest_length, 1.1 * rest_length);
      const double of_first = network.masses[kRow + i] / (network.masses[i] + network.masses[kRow + i]);
      const Vector3 correction = std::max(1.0 - wanted / between.norm(), -1.0) * between;  // by at most its own length
      // Coordinates below 1 are rounded a few times.
      EXPECT_LT((x.col(i) - network.positions.col(i) - of_first * correction).norm(), 16 * kEpsilon) << i;
      EXPECT_LT((x.col(kRow + i) - network.positions.col(kRow + i) + (1.0 - of_first) * correction).norm(), 16 * kEpsilon) << i;
    }
  }
}

// sum of m dx = 0. This also shows that no batch moves a particle twice, which would lose one of the two moves.
TEST(StretchLimit, KeepsTheCentreOfMass) {
  SpringNetwork cloth = make_test_cloth(33, 0.0, 0.0, false);
  cloth.positions *= 1.3;
  for (const SpringNetwork& network : {cloth, make_random_network(200, 3000)}) {
    const StretchLimit limit(network, {.max_stretch = 0.0, .max_compression = 0.0, .kinds = kAllKinds});
    Points x = network.positions;
    const double moved = limit.project(network.positions, x);
    EXPECT_GT(moved, 0.1);
    const Vector3 shift = (x - network.positions) * network.masses;
    // Each of the springs' corrections, of at most some metres, is rounded a few times.
    EXPECT_LT(shift.norm(), 8 * kEpsilon * network.springs.count() * network.masses.maxCoeff());
  }
}

TEST(StretchLimit, NeverMovesPins) {
  SpringNetwork network = make_test_cloth(20, 0.0, 0.0);
  network.positions *= 1.5;
  const StretchLimit limit(network, {});
  Points x = network.positions;
  for (int pass = 0; pass < 50; ++pass) limit.project(network.positions, x);
  for (const Index pinned : network.pins[0].particles) EXPECT_EQ(x.col(pinned), network.positions.col(pinned));
}

TEST(StretchLimit, LeavesSpringsBetweenPinsOut) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_particle(Vector3(2.0, 0.0, 0.0), 1.0);
  builder.add_spring(0, 1, 0.0, 1.0);
  builder.pin({0, 1});
  const SpringNetwork network = builder.build();
  const StretchLimit limit(network, {});
  Points x = network.positions;
  EXPECT_EQ(limit.project(network.positions, x), 0.0);
  EXPECT_EQ(limit.excess(x), 0.0);
  EXPECT_EQ(x, network.positions);
}

TEST(StretchLimit, LimitsOnlyTheGivenKinds) {
  SpringNetwork network = make_test_cloth(5, 0.0, 0.0);
  // Sheared by 45 degrees at constant side lengths: only the diagonals change.
  for (Index i = 0; i < network.particle_count(); ++i) {
    const double y = network.positions(1, i);
    network.positions(0, i) += y * std::sqrt(0.5);
    network.positions(1, i) = y * std::sqrt(0.5);
  }
  EXPECT_LT(StretchLimit(network, {.max_stretch = 0.0}).excess(network.positions), 1e-14);
  EXPECT_GT(StretchLimit(network, {.max_stretch = 0.0, .kinds = kAllKinds}).excess(network.positions), 0.3);
}

TEST(StretchLimit, MeasuresTheExcessOfABodyByItsKinds) {
  SpringNetwork network = make_test_cloth(2, 0.0, 0.0);
  network.positions.row(0) *= 1.5;
  const auto excess_of_body = [&](std::vector<SpringKind> kinds) {
    return StretchLimit(network, {.max_stretch = 0.0, .kinds = std::move(kinds)}).excess(network.positions, network.bodies[0]);
  };
  EXPECT_NEAR(excess_of_body({SpringKind::structural}), 0.5, 4 * kEpsilon);
  // A diagonal of a cell with one side longer by a half.
  EXPECT_NEAR(excess_of_body({SpringKind::shear}), std::sqrt(0.5 * (1.0 + 1.5 * 1.5)) - 1.0, 8 * kEpsilon);
}

TEST(StretchLimit, ReachesItsLimit) {
  // A free cloth stretched by a half in one direction: passes converge until no excess is beyond the tolerance.
  SpringNetwork network = make_test_cloth(12, 0.0, 0.0, false);
  network.positions.row(0) *= 1.5;
  const StretchLimit limit(network, {.max_stretch = 0.02});
  Points x = network.positions;
  for (int pass = 0; pass < 2000; ++pass) limit.project(network.positions, x);
  EXPECT_LT(limit.excess(x), 1.0e-6);
  EXPECT_LT(excess_by_hand(network, limit.settings(), x), 1.0e-6);
}

TEST(StretchLimit, MeasuresTheLargestExcess) {
  SpringNetwork network = make_random_network(100, 777);
  for (const StretchLimitSettings& settings :
       {StretchLimitSettings{.max_stretch = 0.1}, StretchLimitSettings{.max_stretch = 50.0, .max_compression = 0.1}}) {
    const StretchLimit limit(network, settings);
    const double expected = excess_by_hand(network, settings, network.positions);
    EXPECT_NEAR(limit.excess(network.positions), expected, 16 * kEpsilon * (1.0 + expected));
  }
}

TEST(StretchLimit, AcceptsParticlesWithManySprings) {
  // A hub with 300 spokes: more than one round of colours.
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  for (Index i = 1; i <= 300; ++i) {
    builder.add_particle(Vector3(2.0 * std::cos(0.1 * i), 2.0 * std::sin(0.1 * i), 0.01 * i), 1.0);
    builder.add_spring(0, i, 0.0, 1.0);
  }
  builder.pin(0);
  const SpringNetwork network = builder.build();
  const StretchLimit limit(network, {.max_stretch = 0.0});
  Points x = network.positions;
  limit.project(network.positions, x);
  EXPECT_LT(excess_by_hand(network, limit.settings(), x), 4 * kEpsilon) << "one pass suffices: the spokes share only the pin";
}

TEST(StretchLimit, DoesNotMoveASpringWithoutLength) {
  SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  network.positions.col(1) = network.positions.col(0);
  const StretchLimit limit(network, {.max_compression = 0.5});
  Points x = network.positions;
  EXPECT_EQ(limit.project(network.positions, x), 0.5);
  EXPECT_EQ(x, network.positions);
}

TEST(StretchLimit, HasTheSameBitsForAnyNumberOfThreads) {
  SpringNetwork network = make_test_cloth(150, 0.0, 0.0);
  for (Index i = 0; i < network.particle_count(); ++i) network.positions.col(i) *= 1.1 + 0.1 * std::sin(i);
  const StretchLimit limit(network, {.kinds = kAllKinds});
  const auto passes = [&](int threads) {
    const ThreadLimit at_most(threads);
    Points x = network.positions;
    for (int pass = 0; pass < 5; ++pass) limit.project(network.positions, x);
    return x;
  };
  const Points alone = passes(1);
  EXPECT_EQ(passes(2), alone);
  EXPECT_EQ(passes(3), alone);
}

TEST(StretchLimit, AcceptsNetworksWithoutSprings) {
  const SpringNetwork network = make_random_network(3, 0);
  const StretchLimit limit(network, {});
  Points x = network.positions;
  EXPECT_EQ(limit.project(network.positions, x), 0.0);
  EXPECT_EQ(limit.suggested_step(9.81), std::numeric_limits<double>::infinity());
}

/// Excess of a network that hangs from its pins by the limit alone, after it has come to rest.
double excess_hanging(const SpringNetwork& network, const StretchLimitSettings& settings, double dt, double seconds) {
  const StretchLimit limit(network, settings);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  const auto integrator = make_integrator(VerletSettings{.damping_rate = 10.0}, network);
  SimulationState state = initial_state(network);
  integrator->start(state, forces, dt);
  for (; static_cast<double>(state.step) * dt < seconds; ++state.step) {
    const Points before = state.x;
    integrator->advance(state, forces, dt);
    const Points advanced = state.x;
    for (int pass = 0; pass < settings.iterations; ++pass) {
      if (limit.project(before, state.x) <= settings.tolerance) break;
    }
    integrator->recover_velocities(state, forces, before, advanced, dt);
  }
  return limit.excess(state.x);
}

/// A rope that hangs straight down from its first particle.
SpringNetwork hanging_rope(Index particles) {
  SpringNetwork network = make_test_rope(particles, 0.0);
  network.positions.row(1) = -network.positions.row(0);
  network.positions.row(0).setZero();
  return network;
}

/// A cloth that hangs straight down from its whole upper side.
SpringNetwork curtain(Index side) {
  SpringNetwork network = make_test_cloth(side, 0.0, 0.0);
  for (Index i = side * (side - 1); i < side * side; ++i) network.inverse_masses[i] = 0.0;
  return network;
}

// The promised bound, with a tenth for residual motion. Twice the step exceeds the limit, so the suggestion is not needlessly
// small.
TEST(SuggestedStep, KeepsAHangingBodyWithinTheLimit) {
  const StretchLimitSettings settings{.solver = StretchLimitSettings::Solver::gauss_seidel};
  for (const SpringNetwork& network : {hanging_rope(50), hanging_rope(200), curtain(24), make_test_cloth(24, 0.0, 0.0)}) {
    const double dt = StretchLimit(network, settings).suggested_step(9.81);
    const double promised = 0.5 * settings.max_stretch + settings.tolerance;
    EXPECT_LT(excess_hanging(network, settings, dt, 1.0), 1.3 * promised) << network.particle_count();
    EXPECT_GT(excess_hanging(network, settings, 2.0 * dt, 1.0), promised) << network.particle_count();
  }
}

// Without tethers each of the two corners carries half the cloth. With them it carries a strand of 34 springs, 23 down and 11
// across.
TEST(SuggestedStep, IsLargerWithTethersToTautPinsAndKeepsTheLimit) {
  const SpringNetwork cloth = make_test_cloth(24, 0.0, 0.0);
  for (const int passes : {1, 4, 32}) {
    const StretchLimitSettings tethered{.max_stretch = 0.0, .iterations = passes, .tolerance = 0.01, .tethers = true};
    StretchLimitSettings untethered = tethered;
    untethered.tethers = false;
    const double with = StretchLimit(cloth, tethered).suggested_step(9.81);
    const double without = StretchLimit(cloth, untethered).suggested_step(9.81);
    EXPECT_NEAR(with / without, std::sqrt(0.5 * (24 * 24 - 2) / 34.0 / std::cbrt(passes)), 1e-12);
    EXPECT_LT(excess_hanging(cloth, tethered, with, 1.0), 1.3 * tethered.tolerance) << passes;
  }
}

// Between the bounds measured for 16 to 128 particles a side. Twice the step exceeds the limit, so the suggestion is not needlessly
// small.
TEST(SuggestedStep, IsLargerForRigidSurfacesThatMayNotShrink) {
  const SpringNetwork cloth = make_test_cloth(24, 0.0, 0.0);
  StretchLimitSettings both{.max_stretch = 0.0, .max_compression = 0.0, .iterations = 1, .tolerance = 0.01, .tethers = true};
  both.kinds = {SpringKind::structural, SpringKind::shear};
  for (const bool tethers : {false, true}) {
    both.tethers = tethers;
    const double dt = StretchLimit(cloth, both).suggested_step(9.81);
    StretchLimitSettings shrinking = both;
    shrinking.max_compression = 1.0;
    EXPECT_GT(dt, 2.0 * StretchLimit(cloth, shrinking).suggested_step(9.81));
    EXPECT_LT(excess_hanging(cloth, both, dt, 1.0), 1.1 * both.tolerance);
    EXPECT_GT(excess_hanging(cloth, both, 2.0 * dt, 1.0), 2.0 * both.tolerance);
  }
}

// Structural springs alone let a cloth shear, however stiff they are.
TEST(SuggestedStep, IsNoLargerForSurfacesThatMayShear) {
  const SpringNetwork cloth = make_test_cloth(24, 0.0, 0.0);
  const auto step = [&](double max_compression) {
    return StretchLimit(cloth, {.max_stretch = 0.0, .max_compression = max_compression, .tolerance = 0.01}).suggested_step(9.81);
  };
  EXPECT_EQ(step(0.0), step(1.0));
}

TEST(SuggestedStep, IsTheSameWithTethersWhereTheClothSagsBetweenItsPins) {
  const SpringNetwork cloth = make_test_cloth(24, 0.0, 0.0);
  const auto step = [&](bool tethers) {
    return StretchLimit(cloth, {.max_stretch = 0.02, .tethers = tethers}).suggested_step(9.81);
  };
  EXPECT_EQ(step(true), step(false));
}

TEST(SuggestedStep, IsThatOfTheBodyThatNeedsTheSmallest) {
  const auto rope = [](Index particles) {
    BodyShape shape = make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = particles, .length = {}},
                                {.structural = SpringMaterial{}, .shear = {}, .bend = {}});
    set_total_mass(shape, 1.0);
    return shape;
  };
  NetworkBuilder both;
  both.add_body("short", rope(10));
  both.pin(both.add_body("long", rope(90)));
  NetworkBuilder alone;
  alone.pin(alone.add_body("long", rope(90)));
  EXPECT_EQ(StretchLimit(both.build(), {}).suggested_step(9.81), StretchLimit(alone.build(), {}).suggested_step(9.81));
}

/// A cloth that hangs from one corner, and beside it a rope whose pinned ends are as far apart as the rope is long.
SpringNetwork cloth_beside_taut_rope(bool with_rope) {
  const SpringMaterials structural{.structural = SpringMaterial{}, .shear = {}, .bend = {}};
  BodyShape cloth = make_cloth({.size = {1.0, 1.0}, .resolution = {16, 16}}, structural);
  set_total_mass(cloth, 1.0);
  BodyShape rope = make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = 8, .length = {}}, structural);
  set_total_mass(rope, 1.0);
  NetworkBuilder builder;
  builder.pin(builder.add_body("cloth", cloth));
  if (!with_rope) return builder.build();
  const Index first = builder.add_body("rope", rope);
  builder.pin(first);
  builder.pin(first + 7);
  return builder.build();
}

TEST(SuggestedStep, TautPinsOfOneBodyDoNotHelpAnother) {
  const StretchLimitSettings settings{.max_stretch = 0.0, .tolerance = 0.01, .tethers = true};
  const auto step = [&](bool with_rope) { return StretchLimit(cloth_beside_taut_rope(with_rope), settings).suggested_step(9.81); };
  EXPECT_EQ(step(true), step(false));
}

TEST(SuggestedStep, PinsThatMoveAreNotTaut) {
  const auto step = [](bool moves, bool tethers) {
    SpringNetwork cloth = make_test_cloth(12, 0.0, 0.0);
    Motion motion;
    if (moves) motion.spin = Vector3::UnitY();
    for (const Index corner : {132, 143})
      testing::hold(cloth, {.particles = {corner}, .origin = Vector3::Zero(), .motion = motion});
    return StretchLimit(cloth, {.max_stretch = 0.0, .tolerance = 0.01, .tethers = tethers}).suggested_step(9.81);
  };
  EXPECT_GT(step(false, true), step(false, false));
  EXPECT_EQ(step(true, true), step(true, false));
}

// Layers of a limp cloth of 1 m reach a speed of about sqrt(g 1 m) and may move by half of 4 mm.
TEST(StepForLayers, LetsFallingLayersMoveByHalfTheirThickness) {
  SpringNetwork network = make_test_cloth(4, 0.0, 0.0, false);
  Body& body = network.bodies[0];
  body.material.thickness = 0.004;
  const double extent = (network.positions.rowwise().maxCoeff() - network.positions.rowwise().minCoeff()).maxCoeff();
  const StretchLimitSettings settings{.max_stretch = 1.0, .iterations = 1000};
  EXPECT_TRUE(std::isinf(StretchLimit(network, settings).step_for_layers(9.81)));
  body.contact.self = true;
  EXPECT_NEAR(StretchLimit(network, settings).step_for_layers(9.81), 0.002 / std::sqrt(9.81 * extent), 1e-15);
  network.springs.stiffness.assign(network.springs.stiffness.size(), 1.0);
  EXPECT_TRUE(std::isinf(StretchLimit(network, settings).step_for_layers(9.81))) << "springs pull stopped particles back";
}

TEST(SuggestedStep, OfAnUnpinnedRopeIsThatOfItsHalf) {
  // n springs that hang over an obstacle by the middle: n / 2 particles hang from it. A pinned rope of half the length has as
  // many.
  const StretchLimitSettings passes{.solver = StretchLimitSettings::Solver::gauss_seidel};
  NetworkBuilder builder;
  for (Index i = 0; i < 101; ++i) builder.add_particle(Vector3(0.01 * i, 0.0, 0.0), 1.0);
  for (Index i = 0; i < 100; ++i) builder.add_spring(i, i + 1, 0.0, 0.01);
  const double unpinned = StretchLimit(builder.build(), passes).suggested_step(9.81);
  builder.pin(50);  // 100 free particles at one pin
  const double pinned = StretchLimit(builder.build(), passes).suggested_step(9.81);
  EXPECT_NEAR(unpinned / pinned, std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace sprung
