// The mean wind, and the statistics of gusts.
#include "dynamics/air/wind.h"

#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace sprung {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpeed = 3.0;   // [m/s]
constexpr double kLength = 2.0;  // [m]

Wind gusts(std::uint64_t seed, std::vector<WindKeyframe> mean = {}) {
  return Wind(std::move(mean), Gusts{.speed = kSpeed, .length = kLength, .seed = seed});
}

/// Points in a cube of 100 correlation lengths.
Points random_points(Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 100.0 * kLength);
  Points points(3, count);
  for (double& coordinate : points.reshaped()) coordinate = uniform(random);
  return points;
}

TEST(Wind, IsCalmByDefault) {
  EXPECT_TRUE(Wind().is_calm());
  EXPECT_EQ(Wind().velocity(Vector3(1, 2, 3), 4.0), Vector3::Zero());
  EXPECT_EQ(Wind().max_speed(), 0.0);
  EXPECT_FALSE(Wind(Vector3::UnitX()).is_calm());
  EXPECT_FALSE(gusts(1).is_calm());
}

TEST(Wind, IsLinearBetweenKeyframesAndConstantOutside) {
  const Wind wind({{1.0, Vector3(0, 0, 0)}, {3.0, Vector3(4, 0, 2)}, {4.0, Vector3(4, 0, 0)}});
  const auto at = [&](double time) { return wind.velocity(Vector3(7, 8, 9), time); };
  EXPECT_EQ(at(-5.0), Vector3(0, 0, 0));
  EXPECT_EQ(at(1.0), Vector3(0, 0, 0));
  EXPECT_EQ(at(1.5), Vector3(1, 0, 0.5));
  EXPECT_EQ(at(3.0), Vector3(4, 0, 2));
  EXPECT_EQ(at(3.5), Vector3(4, 0, 1));
  EXPECT_EQ(at(9.0), Vector3(4, 0, 0));
}

TEST(Wind, EndsWithTheLastKeyframeIfItChanges) {
  EXPECT_EQ(Wind(Vector3::UnitX()).end(), 0.0);
  EXPECT_EQ(Wind({{1.0, Vector3::UnitX()}, {3.0, Vector3::UnitX()}}).end(), 0.0);
  EXPECT_EQ(Wind({{1.0, Vector3::UnitX()}, {3.0, Vector3::UnitY()}}).end(), 3.0);
  EXPECT_EQ(gusts(1).end(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Wind({}, Gusts{.speed = 0.0}).end(), 0.0);
}

TEST(Wind, HasTheVelocitiesOfItsPointsForAnyNumberOfThreads) {
  const Wind wind = gusts(5, {{0.0, Vector3(1, 2, 3)}, {2.0, Vector3(3, 2, 1)}});
  const Points points = random_points(5003, 1);
  Points alone;
  {
    const ThreadLimit one(1);
    alone = wind.velocities(points, 0.7);
  }
  const ThreadLimit two(2);
  EXPECT_EQ(wind.velocities(points, 0.7), alone);
  for (const Index i : {0, 1, 2, 3, 4, 1024, 5001, 5002}) {
    EXPECT_EQ(wind.velocity(points.col(i), 0.7), Vector3(alone.col(i))) << i;
  }
}

TEST(Gusts, DependOnTheSeedAlone) {
  const Vector3 point(1, 2, 3);
  EXPECT_EQ(gusts(5).velocity(point, 1.0), gusts(5).velocity(point, 1.0));
  EXPECT_GT((gusts(5).velocity(point, 1.0) - gusts(6).velocity(point, 1.0)).norm(), 0.01 * kSpeed);
}

// The mean square over all space is speed^2 for each seed. The square of a vector of three independent normal components of equal
// variance has a standard deviation of sqrt(2 / 3) of its mean; four of them in the mean of 20,000 points are 2.3 %. The sums of
// waves have thinner tails than normal variables, so that this is an upper bound.
TEST(Gusts, HaveTheirRootMeanSquare) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const Points velocities = gusts(seed).velocities(random_points(20000, 10), 0.0);
    const double mean_square = velocities.colwise().squaredNorm().mean();
    EXPECT_NEAR(mean_square / (kSpeed * kSpeed), 1.0, 4.0 * std::sqrt(2.0 / 3.0 / 20000.0)) << seed;
    EXPECT_LT(velocities.colwise().norm().maxCoeff(), gusts(seed).max_speed());
    const double above = (velocities.colwise().norm().array() > gusts(seed).usual_speed()).cast<double>().mean();
    EXPECT_LT(above, 0.01) << "the usual speed is exceeded in 1 % of space";
  }
}

struct Estimate {
  double mean = 0.0;
  double error = 0.0;  ///< standard error of the mean
};

/// The correlation of velocity components along or across the line between two points at a distance, over 400 seeds of 64 pairs of
/// points each.
Estimate correlation(double distance, bool along) {
  constexpr int kSeeds = 400;
  Scalars of_seeds(kSeeds);
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Wind wind = gusts(static_cast<std::uint64_t>(seed));
    const Points points = random_points(64, static_cast<unsigned>(seed));
    const Points here = wind.velocities(points, 0.0);
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const Points there = wind.velocities(points.colwise() + distance * Vector3::Unit(axis), 0.0);
      const int component = along ? axis : (axis + 1) % 3;
      sum += here.row(component).cwiseProduct(there.row(component)).mean() / 3.0;
    }
    of_seeds[seed] = sum / (kSpeed * kSpeed / 3.0);
  }
  const double mean = of_seeds.mean();
  return {mean, std::sqrt((of_seeds.array() - mean).square().mean() / kSeeds)};
}

// The correlations along and across of an isotropic flow without divergence with this spectrum (Batchelor 1953): f and f + r f'
// / 2. The tolerance is five standard errors of 400 independent seeds.
TEST(Gusts, HaveTheirCorrelationAlongAndAcross) {
  for (const double distance : {0.0, 0.5 * kLength, kLength, 2.0 * kLength}) {
    const double exponent = kPi / 4.0 * distance * distance / (kLength * kLength);
    const Estimate along = correlation(distance, true);
    const Estimate across = correlation(distance, false);
    EXPECT_NEAR(along.mean, std::exp(-exponent), 5.0 * along.error) << distance;
    EXPECT_NEAR(across.mean, (1.0 - exponent) * std::exp(-exponent), 5.0 * across.error) << distance;
    EXPECT_LT(along.error, 0.01) << "the tolerance is small";
    EXPECT_LT(across.error, 0.01);
    std::printf("distance %.1f m: correlation along %.3f (%.3f), across %.3f (%.3f)\n", distance, along.mean, std::exp(-exponent),
                across.mean, (1.0 - exponent) * std::exp(-exponent));
  }
}

// Central differences over 2 h are off by h^2 / 6 of the third derivative. Each of 24 waves of amplitude speed sqrt(2 / 24) has at
// most that times |k|^3, with |k| < 6 sigma for all but 1e-6 of the spectrum, sigma = sqrt(pi / 2) / length; rounding is 1e-12.
TEST(Gusts, HaveNoDivergence) {
  const double h = 1e-4 * kLength;
  const double wave_number = 6.0 * std::sqrt(kPi / 2.0) / kLength;
  const double tolerance = 3.0 * kSpeed * std::sqrt(2.0 * 24.0) * h * h / 6.0 * std::pow(wave_number, 3);
  double largest_gradient = 0.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Wind wind = gusts(seed, {{0.0, Vector3(5, 0, 1)}});
    const Points points = random_points(1000, 3);
    for (const auto& point : points.colwise()) {
      double divergence = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3 offset = h * Vector3::Unit(axis);
        const Vector3 slope = (wind.velocity(point + offset, 2.0) - wind.velocity(point - offset, 2.0)) / (2.0 * h);
        divergence += slope[axis];
        largest_gradient = std::max(largest_gradient, slope.cwiseAbs().maxCoeff());
      }
      ASSERT_LT(std::abs(divergence), tolerance);
    }
  }
  EXPECT_GT(largest_gradient, 1000.0 * tolerance) << "control";
}

// Taylor's frozen turbulence: who travels with the mean wind sees the gusts of calm air. The path is the integral of the wind,
// 1 m/s for 1 s, then up to 3 m/s within 2 s, then 3 m/s. Phases are rounded to 1e-16 of some hundred turns.
TEST(Gusts, TravelWithTheMeanWind) {
  const Wind calm = gusts(4);
  const Wind windy = gusts(4, {{1.0, Vector3(1, 0, 0)}, {3.0, Vector3(3, 0, 0)}});
  const auto path = [](double t) {
    return t < 1.0 ? t : t < 3.0 ? 1.0 + (t - 1.0) + 0.5 * (t - 1.0) * (t - 1.0) : 5.0 + 3.0 * (t - 3.0);
  };
  for (const double time : {-2.0, 0.0, 0.5, 1.0, 2.0, 3.0, 4.5}) {
    const Vector3 point(1, 2, 3);
    const Vector3 expected = windy.mean(time) + calm.velocity(point, time);
    EXPECT_LT((windy.velocity(point + Vector3(path(time), 0, 0), time) - expected).norm(), 1e-11) << time;
  }
}

// In calm air they change within about length / speed: hardly in a hundredth of that time, and wholly in 20 times it.
TEST(Gusts, ChangeSlowlyInCalmAir) {
  const Points points = random_points(4000, 5);
  const double time = kLength / kSpeed;
  const auto correlation_after = [&](double later) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const Points now = gusts(seed).velocities(points, 0.0);
      sum += now.cwiseProduct(gusts(seed).velocities(points, later)).colwise().sum().mean() / (kSpeed * kSpeed);
    }
    return sum / 8.0;
  };
  EXPECT_GT(correlation_after(0.01 * time), 0.99);
  // Eight seeds of 24 waves, each of which has a random phase by then: 1 / sqrt(2 * 192) = 0.05.
  EXPECT_LT(std::abs(correlation_after(20.0 * time)), 4.0 * 0.05);
}

}  // namespace
}  // namespace sprung
