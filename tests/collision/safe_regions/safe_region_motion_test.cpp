#include "collision/safe_region_trials.h"
#include "collision/sample_meshes.h"
#include "collision/shapes/mesh_shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

using test::crosses;
using test::Random;

/// A deformation of one mesh into another within 1 s.
struct Transition {
  TriangleMesh from;
  TriangleMesh to;

  [[nodiscard]] MeshShape shape() const {
    return MeshShape(SequenceGeometry{std::make_shared<const MeshSequence>(MeshSequence{
                                          .triangles = from.triangles, .frames = {from.vertices, to.vertices}, .frame_rate = 1.0}),
                                      true});
  }
  [[nodiscard]] TriangleMesh at(double time) const { return {(1.0 - time) * from.vertices + time * to.vertices, from.triangles}; }
};

/// A torus that moves by `drift`, plus up to `wobble` [m] per vertex in a random direction.
Transition wobbling_torus(const Vector3& drift, double wobble) {
  Transition transition{test::torus(1.0, 0.4, 24, 12), test::torus(1.0, 0.4, 24, 12)};
  Random random(17);
  for (Index i = 0; i < transition.to.vertices.cols(); ++i) {
    transition.to.vertices.col(i) += drift + random.between(0.0, wobble) * random.direction();
  }
  return transition;
}

ElementCorners between(const ElementCorners& a, const ElementCorners& b, double fraction) {
  ElementCorners middle = a;
  for (int i = 0; i < a.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    middle.x[k] = (1.0 - fraction) * a.x[k] + fraction * b.x[k];
  }
  return middle;
}

struct Tally {
  int regions = 0;
  int moves = 0;
};

/// Checks that an element never crosses a deforming surface if its corners end in its safe region. Surface and corners move along
/// straight lines.
Tally expect_no_crossing(const Transition& transition, double begin, double end, int trials) {
  const auto in_interval = transition.shape().in_interval(begin, end);
  const ObstacleShape& shape = *in_interval;
  const TriangleMesh before = transition.at(begin);
  Random random(18);
  Tally tally;
  for (int trial = 0; trial < trials; ++trial) {
    const ElementCorners element = test::random_element(before, random, 1 + trial % 3, 0.2, 0.2);
    const SafeRegionRequest request{
        .reach = random.between(0.05, 0.4), .gap = random.between(0.0, 0.05), .clearance = 1e-9, .exact = 0.1};
    SafeRegion region;
    shape.find_region(element, request, region);
    EXPECT_EQ(region.broken, crosses(element, before)) << "trial " << trial;
    if (region.broken) continue;
    ++tally.regions;
    for (int move = 0; move < 4; ++move) {
      ElementCorners moved = element;
      bool inside = true;
      for (int i = 0; i < element.count; ++i) {
        Vector3& corner = moved.x[static_cast<std::size_t>(i)];
        corner = test::moved_within(region, corner + region.drift, request.reach, random);
        inside = inside && test::contains(region, element.x[static_cast<std::size_t>(i)] + region.drift, corner);
      }
      if (!inside) continue;  // the surface came too near to leave room
      ++tally.moves;
      for (const double fraction : {0.2, 0.5, 0.8, 1.0}) {
        EXPECT_FALSE(crosses(between(element, moved, fraction), transition.at(begin + fraction * (end - begin))))
            << "trial " << trial << " at fraction " << fraction;
      }
    }
  }
  return tally;
}

TEST(SafeRegionMotion, NoElementCrossesASurfaceThatWobbles) {
  const Tally tally = expect_no_crossing(wobbling_torus(Vector3::Zero(), 0.05), 0.25, 0.75, 400);
  EXPECT_GT(tally.moves, 2 * tally.regions) << "most elements have room to move";
}

TEST(SafeRegionMotion, NoElementCrossesASurfaceThatMovesFartherThanItsTriangleSize) {
  const Tally tally = expect_no_crossing(wobbling_torus({0.7, -0.5, 0.3}, 0.02), 0.0, 1.0, 400);
  EXPECT_GT(tally.moves, 2 * tally.regions) << "most elements can move with the surface";
}

TEST(SafeRegionMotion, NoElementCrossesASurfaceThatGrowsAndTurns) {
  Transition transition{test::torus(1.0, 0.4, 24, 12), test::torus(1.0, 0.4, 24, 12)};
  const Matrix3 turn = Eigen::AngleAxisd(0.2, Vector3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  transition.to.vertices = 1.1 * turn * transition.to.vertices;
  EXPECT_GT(expect_no_crossing(transition, 0.0, 0.5, 400).moves, 0);
  const Tally slow = expect_no_crossing(transition, 0.4, 0.45, 400);
  EXPECT_GT(slow.moves, 3 * slow.regions);
}

TEST(SafeRegionMotion, NoElementCrossesASurfaceThatItsOwnSurfaceApproaches) {
  // One torus slides under another one at rest. The gap is small enough to catch elements that move with the first one.
  const TriangleMesh torus = test::torus(1.0, 0.4, 24, 12);
  const Eigen::Index vertices = torus.vertices.cols();
  TriangleMesh both{Points(3, 2 * vertices), Triangles(3, 2 * torus.triangles.cols())};
  both.vertices << torus.vertices, torus.vertices.colwise() + Vector3(3.0, 0.85, 0.0);
  both.triangles << torus.triangles, (torus.triangles.array() + static_cast<Index>(vertices)).matrix();
  Transition transition{both, both};
  transition.to.vertices.leftCols(vertices).colwise() += Vector3(3.0, 0.0, 0.0);
  EXPECT_GT(expect_no_crossing(transition, 0.0, 1.0, 800).moves, 800);
}

TEST(SafeRegionMotion, ATranslatedSurfaceTranslatesTheRegion) {
  const Vector3 drift(0.25, -0.5, 0.125);
  const Transition still{test::torus(1.0, 0.4, 24, 12), test::torus(1.0, 0.4, 24, 12)};
  Transition moving = still;
  moving.to.vertices.colwise() += drift;
  const MeshShape rigid(MeshGeometry{std::make_shared<const TriangleMesh>(still.from), true});
  const auto in_interval = moving.shape().in_interval(0.0, 1.0);
  const ObstacleShape& shape = *in_interval;
  Random random(19);
  for (int trial = 0; trial < 200; ++trial) {
    const ElementCorners element = test::random_element(still.from, random, 1 + trial % 3, 0.2, 0.2);
    const SafeRegionRequest request{.reach = 0.3, .gap = 0.02, .clearance = 1e-9, .exact = 0.1};
    SafeRegion expected;
    SafeRegion region;
    rigid.find_region(element, request, expected);
    shape.find_region(element, request, region);
    ASSERT_EQ(region.broken, expected.broken);
    if (region.broken || region.triangle == kNone) continue;
    // Coordinates up to 2 m have rounding errors of 4e-16 m; sums have a few of them.
    ASSERT_LT((region.drift - drift).norm(), 1e-15);
    ASSERT_LT((region.point - expected.point - drift).norm(), 1e-14);
    ASSERT_NEAR(region.distance, expected.distance, 1e-14);
    for (int i = 0; i < element.count; ++i) {
      const Vector3 along = element.x[static_cast<std::size_t>(i)] + drift;
      ASSERT_TRUE(test::contains(region, along, along + 2e-15 * region.normal)) << "trial " << trial;
    }
  }
}

TEST(SafeRegionMotion, ARegionBuiltForTheEndDoesNotMove) {
  const Transition transition = wobbling_torus({0.7, -0.5, 0.3}, 0.05);
  const auto in_interval = transition.shape().in_interval(0.0, 1.0);
  const ObstacleShape& shape = *in_interval;
  Random random(20);
  for (int trial = 0; trial < 200; ++trial) {
    const ElementCorners element = test::random_element(transition.to, random, 3, 0.2, 0.2);
    SafeRegion region;
    shape.find_region(element, {.reach = 0.3, .gap = 0.02, .clearance = 1e-9, .exact = 0.1, .at_end = true}, region);
    ASSERT_EQ(region.broken, crosses(element, transition.to));
    EXPECT_EQ(region.drift, Vector3::Zero());
    for (std::size_t i = 0; !region.broken && i < 3; ++i) ASSERT_TRUE(test::contains(region, element.x[i], element.x[i]));
  }
}

TEST(SafeRegionMotion, ClosestPointsMoveWithTheSurface) {
  // The sheet is stretched to twice its size along x. A point moves by its distance from the middle.
  Transition stretching{test::flat_sheet(4), test::flat_sheet(4)};
  stretching.to.vertices.row(0) *= 2.0;
  const MeshShape shape = stretching.shape();
  ElementCorners element{.count = 1};
  element.x[0] = Vector3(1.2, 0.1, 0.3);
  SafeRegion region;
  shape.in_interval(0.0, 0.25)->find_region(element, {.reach = 0.5, .gap = 0.1, .clearance = 1e-9, .exact = 0.3}, region);
  EXPECT_LT((region.point - Vector3(1.5, 0.0, 0.3)).norm(), 1e-15);
  const auto next = shape.in_interval(0.25, 0.5);
  ASSERT_TRUE(next->advance_region(region));
  EXPECT_LT((region.point - Vector3(1.8, 0.0, 0.3)).norm(), 1e-15);
  ASSERT_TRUE(next->advance_region(region));
  EXPECT_LT((region.point - Vector3(1.8, 0.0, 0.3)).norm(), 1e-15) << "a region advances once per interval";
  EXPECT_FALSE(shape.in_interval(0.75, 1.0)->advance_region(region)) << "the region skipped an interval";
}

}  // namespace
}  // namespace sprung
