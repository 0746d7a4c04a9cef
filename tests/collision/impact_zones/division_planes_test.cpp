// Whatever ends the bounds of held particles leave them, nothing crosses on the way there.
#include "collision/impact_zones/division_planes.h"
#include "collision/meetings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

using test::cross_on_the_way;
using test::Meeting;
using test::Random;
using test::random_ends;
using test::random_meeting;

constexpr double kKept = 1e-3;

/// As far along `way` [m] as the particle's bounds let it go.
Vector3 farthest(const std::vector<DivisionPlanes::Bound>& bounds, Index particle, const Vector3& from, const Vector3& way) {
  double fraction = 1.0;
  for (const DivisionPlanes::Bound& bound : bounds) {
    const double approach = -bound.half_space.normal.dot(way);
    if (bound.particle != particle || !(approach > 0.0)) continue;
    fraction = std::min(fraction, std::max(0.0, bound.half_space.normal.dot(from) - bound.half_space.offset) / approach);
  }
  return from + fraction * way;
}

/// Two triangles of which some particles are pinned, and all go elsewhere. A pin's way does not depend on the others'.
struct Step {
  Meeting meeting;
  Points targets;
  std::vector<char> pinned;
};

Step random_step(Random& random) {
  Step step{.meeting = random_meeting(3, random), .targets = Points(3, 6), .pinned = std::vector<char>(6, 0)};
  for (char& pin : step.pinned) pin = random.between(0.0, 1.0) < 0.4 ? 1 : 0;
  step.targets = random_ends(step.meeting.before, random.between(0.0, 1.0), random.between(0.0, 0.5), random);
  return step;
}

TEST(DivisionPlanes, WithinTheirBoundsSidesDoNotCrossOnTheWay) {
  Random random(1);
  const ParticleDisplacements nothing_carried;
  int gave_way = 0;
  int crossed = 0;
  for (int n = 0; n < 4000; ++n) {
    const Step step = random_step(random);
    DivisionPlanes planes(step.meeting.before, step.targets, step.pinned, nothing_carried, kKept);
    std::vector<ContactStencil> pairs{step.meeting.pair};
    while (planes.hold(pairs)) {
    }
    const bool draws = !planes.passing().empty();
    while (!planes.passing().empty() && planes.give_way(pairs)) {
    }
    if (!planes.passing().empty()) continue;
    gave_way += draws ? 1 : 0;
    crossed += cross_on_the_way(step.meeting.before, step.targets) ? 1 : 0;
    const std::vector<DivisionPlanes::Bound> bounds = planes.bounds(pairs);
    for (int trial = 0; trial < 8; ++trial) {
      Points ends = planes.ends();
      for (const Index i : planes.held())
        ends.col(i) = farthest(bounds, i, ends.col(i), random.between(0.0, 3.0) * random.direction());
      ASSERT_FALSE(cross_on_the_way(step.meeting.before, ends)) << "step " << n << ", trial " << trial;
    }
  }
  EXPECT_GT(gave_way, 400);
  EXPECT_GT(crossed, 400);
}

/// Triangles over each other. Of the lowest and the highest two corners are pinned, which go elsewhere in their planes.
struct Stack {
  static constexpr int kLayers = 6;

  explicit Stack(Random& random) : before(3, 3 * kLayers), targets(3, 3 * kLayers), pinned(3 * kLayers, 0) {
    const double gap = std::pow(10.0, random.between(-7.0, -2.0));
    for (int layer = 0; layer < kLayers; ++layer) {
      auto own = before.middleCols<3>(3 * layer);
      for (int k = 0; k < 3; ++k) own.col(k) << random.between(-1.0, 1.0), layer * gap, random.between(-1.0, 1.0);
      const bool moves = layer == 0 || layer == kLayers - 1;
      targets.middleCols<3>(3 * layer) = moves ? moved_in_plane(own, random) : random_ends(own, 0.3, 0.3, random);
      for (int k = 0; k < 2; ++k) pinned[static_cast<std::size_t>(3 * layer + k)] = moves ? 1 : 0;
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
  std::vector<char> pinned;

 private:
  static Points moved_in_plane(const Points& x, Random& random) {
    const Matrix3 turn = Eigen::AngleAxisd(random.between(-1.0, 1.0), Vector3::UnitY()).toRotationMatrix();
    return (turn * x).colwise() + Vector3(random.between(-0.5, 0.5), 0.0, random.between(-0.5, 0.5));
  }
};

// Where the layers are there is room. Of those that pins draw, places are not found for 22 in 100; 29 if none begins at rest.
TEST(DivisionPlanes, MostOfWhatPinsDrawFindsItsPlace) {
  Random random(2);
  const ParticleDisplacements nothing_carried;
  int drawn = 0;
  int told = 0;
  for (int n = 0; n < 2000; ++n) {
    const Stack stack(random);
    DivisionPlanes planes(stack.before, stack.targets, stack.pinned, nothing_carried, kKept);
    std::vector<ContactStencil> pairs = stack.pairs();
    while (planes.hold(pairs)) {
    }
    drawn += planes.passing().empty() ? 0 : 1;
    while (!planes.passing().empty() && planes.give_way(pairs)) {
    }
    told += planes.passing().empty() ? 0 : 1;
  }
  EXPECT_GT(drawn, 1000);
  EXPECT_LT(told, drawn / 4);
}

}  // namespace
}  // namespace sprung
