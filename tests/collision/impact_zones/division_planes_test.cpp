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
  int crossed = 0;
  for (int n = 0; n < 4000; ++n) {
    const Step step = random_step(random);
    DivisionPlanes planes(step.sides.before, step.targets, step.motions, no_displacements, kKept);
    std::vector<ContactStencil> pairs{step.sides.pair};
    while (planes.constrain(pairs)) {
    }
    if (!planes.crossing().empty()) continue;
    crossed += cross_in_between(step.sides.before, step.targets) ? 1 : 0;
    const std::vector<DivisionPlanes::Bound> bounds = planes.bounds(pairs);
    for (int trial = 0; trial < 8; ++trial) {
      Points ends = planes.ends();
      for (const Index i : planes.constrained())
        ends.col(i) = farthest(bounds, i, ends.col(i), random.between(0.0, 3.0) * random.direction());
      ASSERT_FALSE(cross_in_between(step.sides.before, ends)) << "step " << n << ", trial " << trial;
    }
  }
  EXPECT_GT(crossed, 200);
}

}  // namespace
}  // namespace sprung
