// Wherever constrained particles end within their bounds, nothing crosses in between.
#include "collision/impact_zones/division_planes.h"
#include "collision/nearby_sides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

using test::cross_in_between;
using test::NearbySides;
using test::Random;
using test::random_ends;
using test::random_nearby_sides;

constexpr double kKept = 1e-3;

/// `from` plus as much of the `displacement` [m] as the particle's bounds allow.
Vector3 farthest(const std::vector<DivisionPlanes::Bound>& bounds, Index particle, const Vector3& from,
                 const Vector3& displacement) {
  double fraction = 1.0;
  for (const DivisionPlanes::Bound& bound : bounds) {
    const double approach = -bound.half_space.normal.dot(displacement);
    if (bound.particle != particle || !(approach > 0.0)) continue;
    fraction = std::min(fraction, std::max(0.0, bound.half_space.normal.dot(from) - bound.half_space.offset) / approach);
  }
  return from + fraction * displacement;
}

/// Two triangles with some pinned particles and random targets.
struct Step {
  NearbySides sides;
  Points targets;
  ParticleMotions motions;
};

Step random_step(Random& random) {
  Step step{.sides = random_nearby_sides(3, random), .targets = Points(3, 6), .motions = ParticleMotions(6)};
  for (ParticleMotion& motion : step.motions)
    motion = random.between(0.0, 1.0) < 0.4 ? ParticleMotion::driven : ParticleMotion::free;
  step.targets = random_ends(step.sides.before, random.between(0.0, 1.0), random.between(0.0, 0.5), random);
  return step;
}

TEST(DivisionPlanes, SidesDoNotCrossIfTheirParticlesEndWithinTheirBounds) {
  Random random(1);
  const ParticleDisplacements no_displacements;
  int relaxed = 0;
  int crossed = 0;
  for (int n = 0; n < 4000; ++n) {
    const Step step = random_step(random);
    DivisionPlanes planes(step.sides.before, step.targets, step.motions, no_displacements, kKept);
    std::vector<ContactStencil> pairs{step.sides.pair};
    while (planes.constrain(pairs)) {
    }
    const bool passes = !planes.passing().empty();
    while (!planes.passing().empty() && planes.relax(pairs)) {
    }
    if (!planes.passing().empty()) continue;
    relaxed += passes ? 1 : 0;
    crossed += cross_in_between(step.sides.before, step.targets) ? 1 : 0;
    const std::vector<DivisionPlanes::Bound> bounds = planes.bounds(pairs);
    for (int trial = 0; trial < 8; ++trial) {
      Points ends = planes.ends();
      for (const Index i : planes.constrained())
        ends.col(i) = farthest(bounds, i, ends.col(i), random.between(0.0, 3.0) * random.direction());
      ASSERT_FALSE(cross_in_between(step.sides.before, ends)) << "step " << n << ", trial " << trial;
    }
  }
  EXPECT_GT(relaxed, 400);
  EXPECT_GT(crossed, 400);
}

/// A stack of triangles. Two corners of the lowest and of the highest are pinned and move within their planes.
struct Stack {
  static constexpr int kLayers = 6;

  explicit Stack(Random& random) : before(3, 3 * kLayers), targets(3, 3 * kLayers), motions(3 * kLayers) {
    const double gap = std::pow(10.0, random.between(-7.0, -2.0));
    for (int layer = 0; layer < kLayers; ++layer) {
      auto own = before.middleCols<3>(3 * layer);
      for (int k = 0; k < 3; ++k) own.col(k) << random.between(-1.0, 1.0), layer * gap, random.between(-1.0, 1.0);
      const bool moves = layer == 0 || layer == kLayers - 1;
      targets.middleCols<3>(3 * layer) = moves ? moved_in_plane(own, random) : random_ends(own, 0.3, 0.3, random);
      for (int k = 0; k < 2; ++k)
        motions[static_cast<std::size_t>(3 * layer + k)] = moves ? ParticleMotion::driven : ParticleMotion::free;
    }
  }

  [[nodiscard]] std::vector<ContactStencil> pairs() const {
    std::vector<ContactStencil> all;
    for (int high = 0; high < kLayers; ++high) {
      for (int low = 0; low < high; ++low) {
        all.push_back({.first_count = 3, .second_count = 3});
        for (int k = 0; k < 3; ++k) {
          all.back().particles[static_cast<std::size_t>(k)] = 3 * high + k;
          all.back().particles[static_cast<std::size_t>(3 + k)] = 3 * low + k;
        }
        all.back().normal = separating_direction(all.back(), before);
      }
    }
    return all;
  }

  Points before;
  Points targets;
  ParticleMotions motions;

 private:
  static Points moved_in_plane(const Points& x, Random& random) {
    const Matrix3 turn = Eigen::AngleAxisd(random.between(-1.0, 1.0), Vector3::UnitY()).toRotationMatrix();
    return (turn * x).colwise() + Vector3(random.between(-0.5, 0.5), 0.0, random.between(-0.5, 0.5));
  }
};

// The layers leave room for each other.
TEST(DivisionPlanes, RelaxationSeparatesMostStacksThatPinsDragTogether) {
  Random random(2);
  const ParticleDisplacements no_displacements;
  int dragged = 0;
  int unsolved = 0;
  for (int n = 0; n < 2000; ++n) {
    const Stack stack(random);
    DivisionPlanes planes(stack.before, stack.targets, stack.motions, no_displacements, kKept);
    std::vector<ContactStencil> pairs = stack.pairs();
    while (planes.constrain(pairs)) {
    }
    dragged += planes.passing().empty() ? 0 : 1;
    while (!planes.passing().empty() && planes.relax(pairs)) {
    }
    unsolved += planes.passing().empty() ? 0 : 1;
  }
  EXPECT_GT(dragged, 1000);
  EXPECT_LT(unsolved, dragged / 4);
}

}  // namespace
}  // namespace sprung
