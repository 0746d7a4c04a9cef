#include "dynamics/stretch_newton/component_newton.h"

#include "dynamics/networks.h"
#include "dynamics/stretch_limit/stretch_limit.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <numbers>
#include <random>

namespace sprung {
namespace {

constexpr double kFall = 1.0e-3;  // [m]

Points displaced(const Points& x, std::mt19937& random, double most) {
  std::uniform_real_distribution<double> between(-most, most);
  return x + Points::NullaryExpr(3, x.cols(), [&] { return between(random); });
}

StretchComponent component_of(const SpringNetwork& network) {
  return stretch_components(network, {SpringKind::structural}).front();
}

/// The least energy near x, by many solves that are stopped short as often as they go too far: all that is near its limit is stiff
/// in every other one.
double least_energy(const StretchEnergy& energy, const StretchComponent& component, Points x, const Points& led) {
  const std::unique_ptr<StretchSystemSolver> solver = make_system_solver(component);
  double least = energy.value(x, led);
  StretchSystem system;
  Points step;
  for (int iteration = 0; iteration < 400; ++iteration) {
    energy.linearise(x, led, iteration % 2 == 0 ? NearLimit::slack : NearLimit::stiff, system);
    solver->solve(system, step);
    for (double part = 1.0; part > 1.0e-4; part *= 0.5) {
      Points tried = x;
      tried.leftCols(component.free_count) += part * step;
      const double reached = energy.value(tried, led);
      if (!(reached < least)) continue;
      least = reached;
      x = tried;
      break;
    }
  }
  return least;
}

// A step that begins where forces led adds no motion: links carry the component's mass against the fall alone, which is what the
// energy's weight says. Iterations end with a forecast that was right to a tenth of the energy, so no more than that is left.
TEST(ComponentNewton, EndsWhereNothingIsToBeGained) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0, false);
  const StretchLimitSettings settings{.max_stretch = 0.0};
  std::mt19937 random(2);
  const Points led = displaced(1.1 * network.positions, random, 0.005);
  Points x = led;
  ASSERT_TRUE(ComponentNewton(component_of(network), settings).solve(led, x, kFall));

  const StretchComponent component = component_of(network);
  StretchEnergy energy(component, settings);
  energy.set_weight(network.masses.sum() * kFall);
  const auto of_points = [&](const Points& all) {
    Points points(3, component.free_count);
    for (Index i = 0; i < component.free_count; ++i) points.col(i) = all.col(component.points[i]);
    return points;
  };
  const double reached = energy.value(of_points(x), of_points(led));
  EXPECT_LT(reached - least_energy(energy, component, of_points(x), of_points(led)), 0.1 * reached);
}

// Crumpled, with little that gives way: most whole steps take other links beyond their limit. No solve takes the most iterations.
TEST(ComponentNewton, EndsWhereWholeStepsGoTooFar) {
  const SpringNetwork network = make_test_cloth(14, 0.0, 0.0, false);
  const StretchLimitSettings settings{.max_stretch = 0.0, .kinds = {SpringKind::structural, SpringKind::shear}};
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    const Points led = displaced(network.positions, random, 0.03);
    Points x = led;
    const auto iterations = ComponentNewton(stretch_components(network, settings.kinds).front(), settings).solve(led, x, kFall);
    EXPECT_LT(iterations.value(), 20) << seed;
  }
}

// However its particles were thrown about, what hangs on one link ends within the tolerance, and without one within the limit to
// the last bit: links that carry something are always a little beyond it before they are clipped.
TEST(ComponentNewton, HoldsAChainThatWasThrownAbout) {
  const SpringNetwork network = make_test_rope(1000, 0.0);
  std::mt19937 random(6);
  for (const double tolerance : {0.0, 0.001}) {
    const StretchLimitSettings settings{.max_stretch = 0.01, .tolerance = tolerance};
    const StretchLimit limit(network, settings);
    for (const double most : {0.001, 0.03, 0.1, 10.0}) {
      Points x = displaced(network.positions, random, most);
      x.col(0) = Vector3(most, 0.0, most);
      ComponentNewton(component_of(network), settings).solve(network.positions, x, kFall);
      EXPECT_LE(limit.excess(x), tolerance) << most;
    }
  }
}

// What moves by u in a step is held against that, not against gravity alone: links that carried a fall of a millionth of u would be
// far beyond the tolerance. Of a cloth that turns about its pins none is: they are stiff enough for four times what they carry.
TEST(ComponentNewton, HoldsAgainstMotion) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0);
  const StretchLimitSettings settings{.max_stretch = 0.0, .tolerance = 0.001};
  const double turned = 0.05;
  Points x = network.positions;
  for (Index i = 0; i < x.cols(); ++i) {
    if (!network.is_pinned(i)) x(2, i) += turned * (network.positions.row(1).maxCoeff() - x(1, i));
  }
  const Points before = network.positions;
  ComponentNewton(component_of(network), settings).solve(before, x, 1.0e-6 * turned);
  EXPECT_LE(StretchLimit(network, settings).excess(x), settings.tolerance);
}

// Whatever it does in common, and however many springs are too long: 0.05 of the lower edge's distance to the pins, which is 1 m,
// is a part of 0.05 / sqrt(2) of a square's diagonal. Differences of numbers near 10 keep 14 digits.
TEST(ComponentNewton, TellsHowFarThingsTurn) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0);
  const double turned = 0.05;
  Points x = network.positions;
  for (Index i = 0; i < x.cols(); ++i) x(2, i) += turned * (network.positions.row(1).maxCoeff() - x(1, i));
  for (const double move : {0.0, 10.0}) {
    for (const double max_stretch : {0.0, 1.0}) {
      ComponentNewton newton(component_of(network), {.max_stretch = max_stretch});
      Points led = x.array() + move;
      newton.solve(network.positions, led, kFall);
      EXPECT_NEAR(newton.turn(), turned / std::numbers::sqrt2, 1.0e-13);
    }
  }
}

/// Of a cloth whose links are a little too long or too short.
class EnergyOfACloth : public ::testing::Test {
 protected:
  EnergyOfACloth() { energy_.set_weight(1.0); }

  [[nodiscard]] double linearise(NearLimit near, StretchSystem& system) const { return energy_.linearise(x_, x_, near, system); }
  [[nodiscard]] Vector3 between(std::size_t link) const {
    return x_.col(component_.links[link].second) - x_.col(component_.links[link].first);
  }
  /// Its length as a part of the longest it may be.
  [[nodiscard]] double part(std::size_t link) const { return between(link).norm() / component_.links[link].rest_length; }

  SpringNetwork network_ = make_test_cloth(8, 0.0, 0.0, false);
  StretchComponent component_ = component_of(network_);
  StretchEnergy energy_{component_, {.max_stretch = 0.0}};
  std::mt19937 random_{9};
  Points x_ = displaced(network_.positions, random_, 0.02);
};

// Factors need positive semidefinite blocks, also of links that are shorter than their limit but count as if they pushed. An
// eigenvalue of 0 is off by a few roundings of the largest.
TEST_F(EnergyOfACloth, BlocksAreNeverIndefinite) {
  StretchSystem system;
  EXPECT_GT(linearise(NearLimit::pushing, system), 0.0);
  int short_ones = 0;
  for (std::size_t s = 0; s < system.blocks.size(); ++s) {
    const Matrix3 block = system.blocks[s].matrix();
    const Vector3 eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix3>(block, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1.0e-14 * eigenvalues.maxCoeff());
    if (eigenvalues.maxCoeff() > 0.0 && part(s) < 1.0) ++short_ones;
  }
  EXPECT_GT(short_ones, 0);
}

// As a spring of the links' stiffness k: a displacement along a link is pushed back by k, one across it is not. The energy's weight
// is 1, so k is 1 / (give times rest length), the same for all links of this cloth. Blocks are sums of a few terms no larger than
// k.
TEST_F(EnergyOfACloth, LinksNearTheLimitAreStiffButDoNotPull) {
  StretchSystem slack;
  StretchSystem stiff;
  EXPECT_EQ(linearise(NearLimit::slack, slack), linearise(NearLimit::stiff, stiff));
  EXPECT_EQ(slack.residual, stiff.residual);
  double stiffness = 0.0;
  for (std::size_t s = 0; s < stiff.blocks.size(); ++s) {
    if (part(s) > 1.0) stiffness = between(s).normalized().dot(stiff.blocks[s] * between(s).normalized());
  }
  ASSERT_GT(stiffness, 0.0);
  int near_ones = 0;
  for (std::size_t s = 0; s < stiff.blocks.size(); ++s) {
    if (part(s) > 1.0) {
      EXPECT_EQ(stiff.blocks[s].matrix(), slack.blocks[s].matrix());
      continue;
    }
    EXPECT_EQ(slack.blocks[s].matrix(), Matrix3::Zero());
    const Vector3 along = between(s).normalized();
    const Matrix3 expected = part(s) > 0.9 ? Matrix3(stiffness * along * along.transpose()) : Matrix3(Matrix3::Zero());
    EXPECT_LE((stiff.blocks[s].matrix() - expected).norm(), 1.0e-14 * stiffness);
    near_ones += part(s) > 0.9 ? 1 : 0;
  }
  EXPECT_GT(near_ones, 0);
}

// Where springs have stiffness, a link is near its limit that is shorter by less than half of what the longest is too long where
// forces led: here 2 % of it.
TEST_F(EnergyOfACloth, LinksOfElasticClothsAreNearAsFarAsExcessIsHandedOn) {
  component_.is_elastic = true;
  for (Index i = 0; i < x_.cols(); ++i) x_.col(i) = network_.positions.col(component_.points[i]);
  energy_.find_near(1.04 * x_);
  x_.col(component_.links[0].first) += 0.03 * between(0);
  StretchSystem system;
  EXPECT_GT(linearise(NearLimit::stiff, system), 0.0);
  int slack_ones = 0;
  for (std::size_t s = 0; s < system.blocks.size(); ++s) {
    const bool is_slack = system.blocks[s].matrix() == Matrix3::Zero();
    EXPECT_EQ(is_slack, part(s) < 0.98) << part(s);
    slack_ones += is_slack ? 1 : 0;
  }
  EXPECT_EQ(slack_ones, 1);
}

/// A chain of equal links along a line, so many times as long as it may be, and so many times as long turned about its pin.
class TurnedChain : public ::testing::Test {
 protected:
  /// What the tip and the next are pulled by, and the stiffness k of their link [1/m].
  void turn(double scale, double longer) {
    Points x(3, component_.points.size());
    for (Index i = 0; i < x.cols(); ++i) x.col(i) = network_.positions.col(component_.points[i]);
    const Vector3 pin = x.rightCols(1);
    x = (scale * (x.colwise() - pin)).colwise() + pin;
    between_ = x.col(1) - x.col(0);
    const Vector3 across = between_.unitOrthogonal();
    const Points tried = (Eigen::AngleAxisd(kAngle, across).matrix() * (longer * (x.colwise() - pin))).colwise() + pin;
    StretchEnergy energy(component_, {.max_stretch = 0.0});
    energy.set_weight(1.0);
    energy.linearise(x, x, NearLimit::slack, system_);
    stiffness_ = between_.normalized().dot(system_.blocks.front() * between_.normalized());
    energy.take_turning(x, tried, system_);
  }

  static constexpr double kAngle = 0.3;
  SpringNetwork network_ = make_test_rope(4, 0.0);
  StretchComponent component_ = component_of(network_);
  StretchSystem system_;
  Vector3 between_;
  double stiffness_ = 0.0;
};

// A link of length l that became c l long and turned by an angle a is c l cos a along where it was: a linear model misses the rest.
// Each link pulls its first end as much as its second, so all but the pin's neighbour are in balance. A few roundings of k l.
TEST_F(TurnedChain, PullsBackWhatTurningMadeLonger) {
  turn(1.5, 1.25);
  const Vector3 pull = stiffness_ * 1.25 * (1.0 - std::cos(kAngle)) * between_;
  ASSERT_GT(pull.norm(), 0.0);
  EXPECT_LT((system_.residual.col(0) - pull).norm(), 1.0e-13 * stiffness_ * between_.norm());
  EXPECT_LT(system_.residual.col(1).norm(), 1.0e-13 * stiffness_ * between_.norm());
}

// At 0.84 times 1.2 of the limit a link is too long by less than turning made it longer.
TEST_F(TurnedChain, PullsBackNoFartherThanToTheLimit) {
  turn(1.2, 0.84);
  const Vector3 pull = stiffness_ * (0.84 * 1.2 - 1.0) / 1.2 * between_;
  EXPECT_LT((system_.residual.col(0) - pull).norm(), 1.0e-13 * stiffness_ * between_.norm());
}

TEST_F(TurnedChain, CountsOnlyLinksOfTheSystem) {
  turn(0.9, 1.25);
  EXPECT_EQ(system_.residual, Points::Zero(3, component_.free_count));
}

/// How far a level rope of 8 m, held by both ends and given 2 % to stretch by, falls in 0.3 s on average [m].
double fall_of_level_rope(Index particles) {
  constexpr double kStepFall = 9.81 / 900.0;
  BodyShape shape = make_rope({.points = {Vector3::Zero(), 8.0 * Vector3::UnitX()}, .particles = particles, .length = {}},
                              {.structural = SpringMaterial{}, .shear = {}, .bend = {}});
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  builder.pin({0, particles - 1});
  const SpringNetwork network = builder.build();
  ComponentNewton newton(component_of(network), {.max_stretch = 0.02, .tolerance = 0.005});
  Points before = network.positions;
  Points x = network.positions;
  for (int step = 0; step < 9; ++step) {
    Points led = 2.0 * x - before;
    led.row(1).segment(1, particles - 2).array() -= kStepFall;
    before.swap(x);
    x = led;
    newton.solve(before, x, kStepFall);
  }
  return -x.row(1).mean();
}

// In a step it falls by up to 25 times the length of its links: it took more iterations than there were, stayed near where each
// step began, and fell a third as far.
TEST(ComponentNewton, AFineRopeHeldByBothEndsFallsAsFarAsACoarseOne) {
  EXPECT_NEAR(fall_of_level_rope(2000), fall_of_level_rope(200), 0.02 * fall_of_level_rope(200));
}

/// A cloth in steps of a frame under gravity and what else there is.
class FallingCloth : public ::testing::Test {
 protected:
  /// Returns how many solves the step took. `push` is an acceleration times dt^2 [m].
  int step(const Vector3& push = Vector3::Zero(), const Vector3& pins_at = Vector3::Zero()) {
    Points led = 2.0 * x_ - before_;
    led.colwise() += push - kFrameFall * Vector3::UnitY();
    for (Index i = 0; i < led.cols(); ++i) {
      if (network_.is_pinned(i)) led.col(i) = network_.positions.col(i) + pins_at;
    }
    before_.swap(x_);
    x_ = led;
    return newton_.solve(before_, x_, kFrameFall).value_or(0);
  }

  /// Until nothing moves any more. What stops without a solve may take one once its speed is gone from where forces lead.
  void come_to_rest() {
    int still = 0;
    for (int n = 0; n < 600 && still < 2; ++n) still = step() == 0 && x_ == before_ ? still + 1 : 0;
    ASSERT_EQ(still, 2);
  }

  static constexpr double kFrameFall = 9.81 / 3600.0;
  SpringNetwork network_ = make_test_cloth(48, 0.0, 0.0);
  const StretchLimitSettings kLimit{.max_stretch = 0.0, .tolerance = 0.01};
  ComponentNewton newton_{component_of(network_), kLimit};
  Points before_ = network_.positions;
  Points x_ = network_.positions;
};

// Its links are all at their limit when it starts to fall: each iteration must not find only the next few that a step makes too
// long, by pulling or by turning them.
TEST_F(FallingCloth, TakesFewSolvesForWhatBeginsAtItsLimit) {
  for (int n = 0; n < 20; ++n) EXPECT_LE(step(), 3) << "step " << n;
}

TEST_F(FallingCloth, ComesToRestAndStaysThere) {
  come_to_rest();
  const Points rest = x_;
  for (int n = 0; n < 20; ++n) EXPECT_EQ(step(), 0);
  EXPECT_EQ(x_, rest);
}

// Links of k = 25 kg that are off by 5 nm lead their particles of m = 0.09 g, were these free, by k / m times as much, half of what
// gravity does in a step; but all that can be gained is k times the square of 5 nm, a ten thousandth of what gravity's is worth.
TEST_F(FallingCloth, TakesOneSolveToTellThatNothingIsToBeGained) {
  come_to_rest();
  const Points rest = x_;
  std::mt19937 random(8);
  for (int n = 0; n < 10; ++n) {
    x_ = displaced(rest, random, 5.0e-9);
    for (Index i = 0; i < x_.cols(); ++i) {
      if (network_.is_pinned(i)) x_.col(i) = rest.col(i);
    }
    before_ = x_;
    EXPECT_EQ(step(), n == 0 ? 1 : 0) << n;
  }
}

// Rest leaves a six hundredth of the way from where forces lead, of which its last motion may have taken most. A ten thousandth
// along gravity changes the energy by many times what rest leaves, and moves its minimum next to nowhere.
TEST_F(FallingCloth, RestsUntilForcesLeadElsewhere) {
  come_to_rest();
  const Points rest = x_;
  for (const Vector3& way : {Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0), Vector3(0.0, 0.0, 1.0)}) {
    for (const double part : {-1.0e-4, 1.0e-4}) {
      EXPECT_EQ(step(part * kFrameFall * way), 0) << part * way.transpose();
      EXPECT_TRUE(x_ == rest);
    }
  }
  EXPECT_GT(step(-0.01 * kFrameFall * Vector3::UnitY()), 0);
}

// A wind of a tenth of its weight leads what is slack by as much in its first step; links hold some of it back.
TEST_F(FallingCloth, DoesNotRestOnceForcesChange) {
  come_to_rest();
  const Points rest = x_;
  EXPECT_GT(step(0.1 * kFrameFall * Vector3::UnitZ()), 0);
  EXPECT_GT((x_ - rest).row(2).mean(), 0.01 * kFrameFall);
}

// Which changes no energy where it rests.
TEST_F(FallingCloth, DoesNotRestOnceForcesTurn) {
  come_to_rest();
  const Points rest = x_;
  ComponentNewton newton(component_of(network_), kLimit);
  const auto solves_from_rest = [&](const Vector3& load) {
    for (Index i = 0; i < x_.cols(); ++i) x_.col(i) = rest.col(i) + (network_.is_pinned(i) ? Vector3(Vector3::Zero()) : load);
    return newton.solve(rest, x_, kFrameFall).value_or(0);
  };
  solves_from_rest(-kFrameFall * Vector3::UnitY());
  EXPECT_EQ(solves_from_rest(-kFrameFall * Vector3::UnitY()), 0);
  constexpr double kTurn = 0.1;
  EXPECT_GT(solves_from_rest(kFrameFall * Vector3(0.0, -std::cos(kTurn), std::sin(kTurn))), 0);
  EXPECT_GT((x_ - rest).row(2).mean(), 0.5 * kTurn * kFrameFall);
}

TEST_F(FallingCloth, DoesNotRestOncePinsMove) {
  come_to_rest();
  const double moved = 0.1 * kFrameFall;
  EXPECT_GT(step(Vector3::Zero(), moved * Vector3::UnitX()), 0);
  EXPECT_GT(step(Vector3::Zero(), moved * Vector3::UnitY()), 0);
}

// What all move in common changes neither the solution but for that move, nor how many solves lead there: rounding at 10 m is all
// the difference. It may round numbers of a factor in single precision the other way, by 6e-8, and corrections of some 0.1 m with
// them, times what condition makes of it.
TEST(ComponentNewton, DoesNotSeeACommonMove) {
  for (const bool pinned : {false, true}) {
    const SpringNetwork network = make_test_cloth(8, 0.0, 0.0, pinned);
    ComponentNewton newton(component_of(network), {.max_stretch = 0.0});
    std::mt19937 random(4);
    const Vector3 move(10.0, -3.0, 1.0);
    Points x = displaced(1.02 * network.positions, random, 0.01);
    for (Index i = 0; i < x.cols(); ++i) {
      if (network.is_pinned(i)) x.col(i) = network.positions.col(i);
    }
    Points moved = x.colwise() + move;
    const auto solves = newton.solve(network.positions, x, kFall);
    ASSERT_TRUE(solves);
    EXPECT_EQ(newton.solve(network.positions, moved, kFall), solves);
    EXPECT_LT((moved - (x.colwise() + move)).cwiseAbs().maxCoeff(), 1.0e-6);
  }
}

}  // namespace
}  // namespace sprung
