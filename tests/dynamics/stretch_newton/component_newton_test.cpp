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

/// The least energy near x, by many solves with backtracking line searches. In every other solve all links near their limit are
/// stiff.
double least_energy(const StretchEnergy& energy, const StretchComponent& component, Points x, const Points& target) {
  const std::unique_ptr<StretchSystemSolver> solver = make_system_solver(component);
  double least = energy.value(x, target);
  StretchSystem system;
  Points step;
  for (int iteration = 0; iteration < 400; ++iteration) {
    energy.linearise(x, target, iteration % 2 == 0 ? NearLimit::slack : NearLimit::stiff, system);
    solver->solve(system, step);
    for (double fraction = 1.0; fraction > 1.0e-4; fraction *= 0.5) {
      Points tried = x;
      tried.leftCols(component.free_count) += fraction * step;
      const double reached = energy.value(tried, target);
      if (!(reached < least)) continue;
      least = reached;
      x = tried;
      break;
    }
  }
  return least;
}

// A step that begins at the target adds no motion: links carry the component's mass against the fall alone, which sets the load
// of the energy. Iterations end when a forecast was accurate to a tenth of the energy, so no more than that remains.
TEST(ComponentNewton, ConvergesToTheMinimum) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0, false);
  const StretchLimitSettings settings{.max_stretch = 0.0};
  std::mt19937 random(2);
  const Points target = displaced(1.1 * network.positions, random, 0.005);
  Points x = target;
  ASSERT_TRUE(ComponentNewton(component_of(network), settings).solve(target, x, kFall));

  const StretchComponent component = component_of(network);
  StretchEnergy energy(component, settings);
  energy.set_load(network.masses.sum() * kFall);
  const auto of_points = [&](const Points& all) {
    Points points(3, component.free_count);
    for (Index i = 0; i < component.free_count; ++i) points.col(i) = all.col(component.points[i]);
    return points;
  };
  const double reached = energy.value(of_points(x), of_points(target));
  EXPECT_LT(reached - least_energy(energy, component, of_points(x), of_points(target)), 0.1 * reached);
}

// In this crumpled cloth of rigid links most full steps push other links beyond their limit. No solve takes the maximum of
// iterations.
TEST(ComponentNewton, ConvergesWhereFullStepsOvershoot) {
  const SpringNetwork network = make_test_cloth(14, 0.0, 0.0, false);
  const StretchLimitSettings settings{.max_stretch = 0.0, .kinds = {SpringKind::structural, SpringKind::shear}};
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    const Points target = displaced(network.positions, random, 0.03);
    Points x = target;
    const auto iterations = ComponentNewton(stretch_components(network, settings.kinds).front(), settings).solve(target, x, kFall);
    EXPECT_LT(iterations.value(), 20) << seed;
  }
}

// After any displacement a chain that hangs on one link ends within the tolerance; without a tolerance it ends within the limit to
// the last bit. Links that carry a load exceed the limit slightly before they are clipped.
TEST(ComponentNewton, KeepsAScatteredChainWithinTheTolerance) {
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

// A cloth that moves by u in a step has a load of that motion, not of gravity alone: links for a fall of a millionth of u would
// far exceed the tolerance. Links of a cloth that rotates about its pins stay within it, as they are stiff enough for four times
// their load.
TEST(ComponentNewton, CarriesTheLoadOfMotion) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0);
  const StretchLimitSettings settings{.max_stretch = 0.0, .tolerance = 0.001};
  const double turned = 0.05;
  Points x = network.positions;
  for (Index i = 0; i < x.cols(); ++i) {
    if (!network.is_fixed(i)) x(2, i) += turned * (network.positions.row(1).maxCoeff() - x(1, i));
  }
  const Points before = network.positions;
  ComponentNewton(component_of(network), settings).solve(before, x, 1.0e-6 * turned);
  EXPECT_LE(StretchLimit(network, settings).excess(x), settings.tolerance);
}

// The common displacement and the number of excessive springs do not matter. The displacement is 0.05 of the lower edge's distance
// from the pins, which is 1 m: 0.05 / sqrt(2) of a square's diagonal. Differences of numbers near 10 keep 14 digits.
TEST(ComponentNewton, ReportsTheRelativeDeformation) {
  const SpringNetwork network = make_test_cloth(8, 0.0, 0.0);
  const double turned = 0.05;
  Points x = network.positions;
  for (Index i = 0; i < x.cols(); ++i) x(2, i) += turned * (network.positions.row(1).maxCoeff() - x(1, i));
  for (const double move : {0.0, 10.0}) {
    for (const double max_stretch : {0.0, 1.0}) {
      ComponentNewton newton(component_of(network), {.max_stretch = max_stretch});
      Points target = x.array() + move;
      newton.solve(network.positions, target, kFall);
      EXPECT_NEAR(newton.deformation(), turned / std::numbers::sqrt2, 1.0e-13);
    }
  }
}

/// The energy of a cloth whose links are slightly too long or too short.
class EnergyOfACloth : public ::testing::Test {
 protected:
  EnergyOfACloth() { energy_.set_load(1.0); }

  [[nodiscard]] double linearise(NearLimit near, StretchSystem& system) const { return energy_.linearise(x_, x_, near, system); }
  [[nodiscard]] Vector3 between(std::size_t link) const {
    return x_.col(component_.links[link].second) - x_.col(component_.links[link].first);
  }
  /// The length of a link as a fraction of its limit.
  [[nodiscard]] double fraction(std::size_t link) const { return between(link).norm() / component_.links[link].rest_length; }

  SpringNetwork network_ = make_test_cloth(8, 0.0, 0.0, false);
  StretchComponent component_ = component_of(network_);
  StretchEnergy energy_{component_, {.max_stretch = 0.0}};
  std::mt19937 random_{9};
  Points x_ = displaced(network_.positions, random_, 0.02);
};

// Factors need positive semidefinite blocks, also for links shorter than their limit that are treated as pushing. An eigenvalue of
// 0 is off by a few roundings of the largest one.
TEST_F(EnergyOfACloth, BlocksAreNeverIndefinite) {
  StretchSystem system;
  EXPECT_GT(linearise(NearLimit::pushing, system), 0.0);
  int short_ones = 0;
  for (std::size_t s = 0; s < system.blocks.size(); ++s) {
    const Matrix3 block = system.blocks[s].matrix();
    const Vector3 eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix3>(block, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1.0e-14 * eigenvalues.maxCoeff());
    if (eigenvalues.maxCoeff() > 0.0 && fraction(s) < 1.0) ++short_ones;
  }
  EXPECT_GT(short_ones, 0);
}

// A stiff link acts like a spring of stiffness k: it resists a displacement along the link with k and one across it not at all.
// The load is 1 kg m, so k is 1 / (give times rest length), the same for all links of this cloth. Blocks are sums of a few terms no
// larger than k.
TEST_F(EnergyOfACloth, LinksNearTheLimitAreStiffButDoNotPull) {
  StretchSystem slack;
  StretchSystem stiff;
  EXPECT_EQ(linearise(NearLimit::slack, slack), linearise(NearLimit::stiff, stiff));
  EXPECT_EQ(slack.residual, stiff.residual);
  double stiffness = 0.0;
  for (std::size_t s = 0; s < stiff.blocks.size(); ++s) {
    if (fraction(s) > 1.0) stiffness = between(s).normalized().dot(stiff.blocks[s] * between(s).normalized());
  }
  ASSERT_GT(stiffness, 0.0);
  int near_ones = 0;
  for (std::size_t s = 0; s < stiff.blocks.size(); ++s) {
    if (fraction(s) > 1.0) {
      EXPECT_EQ(stiff.blocks[s].matrix(), slack.blocks[s].matrix());
      continue;
    }
    EXPECT_EQ(slack.blocks[s].matrix(), Matrix3::Zero());
    const Vector3 along = between(s).normalized();
    const Matrix3 expected = fraction(s) > 0.9 ? Matrix3(stiffness * along * along.transpose()) : Matrix3(Matrix3::Zero());
    EXPECT_LE((stiff.blocks[s].matrix() - expected).norm(), 1.0e-14 * stiffness);
    near_ones += fraction(s) > 0.9 ? 1 : 0;
  }
  EXPECT_GT(near_ones, 0);
}

// Where springs have stiffness, a link is near its limit if it is shorter by less than half of the largest excess at the target:
// here 2 % of its limit.
TEST_F(EnergyOfACloth, LinksOfElasticClothsAreNearWithinHalfTheLargestExcess) {
  component_.is_elastic = true;
  for (Index i = 0; i < x_.cols(); ++i) x_.col(i) = network_.positions.col(component_.points[i]);
  energy_.find_near(1.04 * x_);
  x_.col(component_.links[0].first) += 0.03 * between(0);
  StretchSystem system;
  EXPECT_GT(linearise(NearLimit::stiff, system), 0.0);
  int slack_ones = 0;
  for (std::size_t s = 0; s < system.blocks.size(); ++s) {
    const bool is_slack = system.blocks[s].matrix() == Matrix3::Zero();
    EXPECT_EQ(is_slack, fraction(s) < 0.98) << fraction(s);
    slack_ones += is_slack ? 1 : 0;
  }
  EXPECT_EQ(slack_ones, 1);
}

/// A straight chain of equal links, scaled relative to its limit, then scaled again and rotated about its pin.
class TurnedChain : public ::testing::Test {
 protected:
  /// Computes the residual that the linear model missed, the vector between the tip and its neighbour, and the stiffness k of
  /// their link [1/m].
  void turn(double scale, double longer) {
    Points x(3, component_.points.size());
    for (Index i = 0; i < x.cols(); ++i) x.col(i) = network_.positions.col(component_.points[i]);
    const Vector3 pin = x.rightCols(1);
    x = (scale * (x.colwise() - pin)).colwise() + pin;
    between_ = x.col(1) - x.col(0);
    const Vector3 across = between_.unitOrthogonal();
    const Points tried = (Eigen::AngleAxisd(kAngle, across).matrix() * (longer * (x.colwise() - pin))).colwise() + pin;
    StretchEnergy energy(component_, {.max_stretch = 0.0});
    energy.set_load(1.0);
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

// A link of length l that became c l long and rotated by an angle a has the length c l cos a along its former direction; a linear
// model misses the rest. Each link pulls both ends equally, so all points but the tip and the pin's neighbour are in balance. The
// tolerance is a few roundings of k l.
TEST_F(TurnedChain, PullsBackLinksThatRotationLengthened) {
  turn(1.5, 1.25);
  const Vector3 pull = stiffness_ * 1.25 * (1.0 - std::cos(kAngle)) * between_;
  ASSERT_GT(pull.norm(), 0.0);
  EXPECT_LT((system_.residual.col(0) - pull).norm(), 1.0e-13 * stiffness_ * between_.norm());
  EXPECT_LT(system_.residual.col(1).norm(), 1.0e-13 * stiffness_ * between_.norm());
}

// At 0.84 times 1.2 of the limit the excess of a link is less than the length that the rotation added.
TEST_F(TurnedChain, PullsBackAtMostToTheLimit) {
  turn(1.2, 0.84);
  const Vector3 pull = stiffness_ * (0.84 * 1.2 - 1.0) / 1.2 * between_;
  EXPECT_LT((system_.residual.col(0) - pull).norm(), 1.0e-13 * stiffness_ * between_.norm());
}

TEST_F(TurnedChain, CountsOnlyLinksOfTheSystem) {
  turn(0.9, 1.25);
  EXPECT_EQ(system_.residual, Points::Zero(3, component_.free_count));
}

/// How far a level rope of 8 m, pinned at both ends and allowed to stretch by 2 %, falls in 0.3 s on average [m].
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
    Points target = 2.0 * x - before;
    target.row(1).segment(1, particles - 2).array() -= kStepFall;
    before.swap(x);
    x = target;
    newton.solve(before, x, kStepFall);
  }
  return -x.row(1).mean();
}

// In a step the rope falls by up to 25 times the length of its links. With too few iterations it stayed near the beginning of each
// step and fell a third as far.
TEST(ComponentNewton, AFineRopePinnedAtBothEndsFallsAsFarAsACoarseOne) {
  EXPECT_NEAR(fall_of_level_rope(2000), fall_of_level_rope(200), 0.02 * fall_of_level_rope(200));
}

/// A cloth in steps of one frame, under gravity and a push.
class FallingCloth : public ::testing::Test {
 protected:
  /// Returns the number of solves in the step. `push` is an acceleration times dt^2 [m].
  int step(const Vector3& push = Vector3::Zero(), const Vector3& pins_at = Vector3::Zero()) {
    Points target = 2.0 * x_ - before_;
    target.colwise() += push - kFrameFall * Vector3::UnitY();
    for (Index i = 0; i < target.cols(); ++i) {
      if (network_.is_fixed(i)) target.col(i) = network_.positions.col(i) + pins_at;
    }
    before_.swap(x_);
    x_ = target;
    return newton_.solve(before_, x_, kFrameFall).value_or(0);
  }

  /// Steps until nothing moves any more. A cloth that stops without a solve may take one more when its speed has become zero.
  void come_to_rest() {
    int still = 0;
    for (int n = 0; n < 600 && still < 2; ++n) still = step() == 0 && x_ == before_ ? still + 1 : 0;
    ASSERT_EQ(still, 2);
  }

  static constexpr double kFrameFall = 9.81 / 3600.0;
  SpringNetwork network_ = make_test_cloth(48, 0.0, 0.0);
  const StretchLimitSettings settings_{.max_stretch = 0.0, .tolerance = 0.01};
  ComponentNewton newton_{component_of(network_), settings_};
  Points before_ = network_.positions;
  Points x_ = network_.positions;
};

// All links are at their limit when the cloth starts to fall. An iteration must not add only the next few links that a step makes
// too long by pulling or rotating them.
TEST_F(FallingCloth, TakesFewSolvesFromTheLimit) {
  for (int n = 0; n < 20; ++n) EXPECT_LE(step(), 3) << "step " << n;
}

TEST_F(FallingCloth, ComesToRestAndStaysThere) {
  come_to_rest();
  const Points rest = x_;
  for (int n = 0; n < 20; ++n) EXPECT_EQ(step(), 0);
  EXPECT_EQ(x_, rest);
}

// An error of 5 nm in links of k = 25 kg would displace free particles of m = 0.09 g by k / m times as much, half of the
// displacement by gravity in a step. The energy that a solve can gain is only k times the square of 5 nm, a ten thousandth of
// gravity's.
TEST_F(FallingCloth, DetectsTheMinimumInOneSolve) {
  come_to_rest();
  const Points rest = x_;
  std::mt19937 random(8);
  for (int n = 0; n < 10; ++n) {
    x_ = displaced(rest, random, 5.0e-9);
    for (Index i = 0; i < x_.cols(); ++i) {
      if (network_.is_fixed(i)) x_.col(i) = rest.col(i);
    }
    before_ = x_;
    EXPECT_EQ(step(), n == 0 ? 1 : 0) << n;
  }
}

// A cloth at rest ignores a six hundredth of the displacement by forces, most of which its last motion may have used. A ten
// thousandth along gravity changes the energy by many times what rest ignores, but hardly moves its minimum.
TEST_F(FallingCloth, RestsUntilTheLoadChanges) {
  come_to_rest();
  const Points rest = x_;
  for (const Vector3& direction : {Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0), Vector3(0.0, 0.0, 1.0)}) {
    for (const double fraction : {-1.0e-4, 1.0e-4}) {
      EXPECT_EQ(step(fraction * kFrameFall * direction), 0) << fraction * direction.transpose();
      EXPECT_TRUE(x_ == rest);
    }
  }
  EXPECT_GT(step(-0.01 * kFrameFall * Vector3::UnitY()), 0);
}

// A wind of a tenth of the weight moves slack links by as much in the first step; taut links reduce the motion.
TEST_F(FallingCloth, LeavesRestWhenForcesChange) {
  come_to_rest();
  const Points rest = x_;
  EXPECT_GT(step(0.1 * kFrameFall * Vector3::UnitZ()), 0);
  EXPECT_GT((x_ - rest).row(2).mean(), 0.01 * kFrameFall);
}

// A rotated load does not change the energy at the resting positions.
TEST_F(FallingCloth, LeavesRestWhenForcesRotate) {
  come_to_rest();
  const Points rest = x_;
  ComponentNewton newton(component_of(network_), settings_);
  const auto solves_from_rest = [&](const Vector3& load) {
    for (Index i = 0; i < x_.cols(); ++i) x_.col(i) = rest.col(i) + (network_.is_fixed(i) ? Vector3(Vector3::Zero()) : load);
    return newton.solve(rest, x_, kFrameFall).value_or(0);
  };
  solves_from_rest(-kFrameFall * Vector3::UnitY());
  EXPECT_EQ(solves_from_rest(-kFrameFall * Vector3::UnitY()), 0);
  constexpr double kTurn = 0.1;
  EXPECT_GT(solves_from_rest(kFrameFall * Vector3(0.0, -std::cos(kTurn), std::sin(kTurn))), 0);
  EXPECT_GT((x_ - rest).row(2).mean(), 0.5 * kTurn * kFrameFall);
}

TEST_F(FallingCloth, LeavesRestWhenPinsMove) {
  come_to_rest();
  const double moved = 0.1 * kFrameFall;
  EXPECT_GT(step(Vector3::Zero(), moved * Vector3::UnitX()), 0);
  EXPECT_GT(step(Vector3::Zero(), moved * Vector3::UnitY()), 0);
}

// A common displacement is added to the solution and changes neither its shape nor the number of solves. The difference is
// rounding at 10 m. A factor in single precision may round by 6e-8 differently, and so may corrections of some 0.1 m, multiplied
// by the condition number.
TEST(ComponentNewton, IsInvariantUnderACommonDisplacement) {
  for (const bool pinned : {false, true}) {
    const SpringNetwork network = make_test_cloth(8, 0.0, 0.0, pinned);
    ComponentNewton newton(component_of(network), {.max_stretch = 0.0});
    std::mt19937 random(4);
    const Vector3 move(10.0, -3.0, 1.0);
    Points x = displaced(1.02 * network.positions, random, 0.01);
    for (Index i = 0; i < x.cols(); ++i) {
      if (network.is_fixed(i)) x.col(i) = network.positions.col(i);
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
