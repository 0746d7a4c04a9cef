#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include "collision/sample_meshes.h"
#include "collision/self_networks.h"
#include "collision/single_particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace sprung {
namespace {

// The broad phase searches around the elements' paths. Obstacles elsewhere have no regions, so no particle may go there.
TEST(ObstacleSafeRegions, AllowNoPositionOutsideOfTheSearchedBox) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.5}};
  ball.rest_pose.translation() = Vector3(10.0, 0.0, 0.0);
  const ObstacleSet obstacles({ball});
  const ObstacleFrame frame(obstacles, 0.0, 0.01);
  const CollisionSurface surface = test::particle_surface(ParticleMotions(1));
  const Points here = Points::Zero(3, 1);
  ObstacleSafeRegions regions(obstacles, surface, here, 0.01);
  regions.update({frame, here, here});
  std::vector<HalfSpace> half_spaces;
  regions.append_half_spaces(frame, 0, half_spaces);
  const auto is_within = [&](const Vector3& p) {
    return std::ranges::all_of(half_spaces, [&](const HalfSpace& bound) { return bound.normal.dot(p) >= bound.offset; });
  };
  EXPECT_TRUE(regions.allow(frame, 0, here.col(0)));
  EXPECT_TRUE(is_within(here.col(0)));
  EXPECT_FALSE(regions.allow(frame, 0, ball.rest_pose.translation()));
  EXPECT_FALSE(is_within(ball.rest_pose.translation()));
}

// A region that is renewed because one corner leaves it has other planes. They may not contain the target of another corner, which
// then has to be listed as leaving too. A cloth moves at random over rough ground; particles that are not listed move unclipped.
TEST(ObstacleSafeRegions, ListEveryParticleWhoseTargetANewRegionExcludes) {
  constexpr Index kSide = 10;
  constexpr int kSteps = 1000;
  constexpr double kMaxStep = 0.1;
  test::Random random(1);
  const TriangleMesh ground = test::terrain(12, [&](Index, Index) { return random.between(0.0, 1.0); });
  const Obstacle obstacle{.name = "ground", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(ground), false}};
  const ObstacleSet obstacles({obstacle});
  const ObstacleFrame frame(obstacles, 0.0, 0.01);
  test::SelfNetwork cloth;
  cloth.add_cloth(kSide, {-4.0, 1.1, -4.0}, {0.8, 0.0, 0.0}, {0.0, 0.0, 0.8});
  const CollisionSurface surface = cloth.surface(0.05);
  ObstacleSafeRegions regions(obstacles, surface, cloth.positions, 0.05);
  Points from = cloth.positions;
  for (int step = 0; step < kSteps; ++step) {
    Points to = from;
    for (Index i = 0; i < cloth.count(); ++i) {
      to.col(i) += random.between(0.0, kMaxStep) * random.direction() - Vector3(0.0, 0.2 * kMaxStep, 0.0);
    }
    regions.update({frame, from, to});
    const std::vector<Index> leaving = regions.leaving();
    for (Index i = 0; i < cloth.count(); ++i) {
      if (std::ranges::binary_search(leaving, i)) continue;
      ASSERT_TRUE(regions.allow(frame, i, to.col(i))) << "particle " << i << " in step " << step;
      from.col(i) = to.col(i);
    }
  }
}

/// The contact's point on the element.
Vector3 element_point(const Contact& contact, const Points& positions) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
    sum += contact.weights[k] * positions.col(contact.particles[k]);
  }
  return sum;
}

struct Top {
  const char* name;
  ObstacleGeometry geometry;
};

void PrintTo(const Top& top, std::ostream* stream) { *stream << top.name; }

/// Open pyramids, 1 m high, with their tips here.
TriangleMesh spikes(const std::vector<Vector3>& tips) {
  const auto count = static_cast<Index>(tips.size());
  TriangleMesh mesh{Points(3, 5 * count), Triangles(3, 4 * count)};
  for (Index k = 0; k < count; ++k) {
    Eigen::Matrix<double, 5, 3> corners;
    corners << 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, -1.0, -1.0, -1.0, -1.0, 0.0, 0.0, -1.0, 1.0;
    mesh.vertices.middleCols(5 * k, 5) = corners.transpose().colwise() + tips[static_cast<std::size_t>(k)];
    Eigen::Matrix<Index, 4, 3> faces;
    faces << 0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1;
    mesh.triangles.middleCols(4 * k, 4) = (faces.array() + 5 * k).transpose();
  }
  return mesh;
}

/// A square above an obstacle, with one corner here and sides along x and z.
struct SquareAbove {
  SquareAbove(const Obstacle& obstacle, const Vector3& corner) : obstacles({obstacle}) {
    square.add_cloth(1, corner, Vector3::UnitX(), Vector3::UnitZ());
    surface = square.surface(kGap);
    regions.emplace(obstacles, surface, square.positions, 0.5 * kGap);
  }

  /// In a step that ends at `time` [s].
  std::vector<Contact> step(const Points& from, const Points& to, double time = kStep) {
    const ObstacleFrame frame(obstacles, time - kStep, time);
    regions->update({frame, from, to});
    std::vector<Contact> contacts;
    regions->find_contacts({frame, from, to}, contacts);
    return contacts;
  }

  static constexpr double kGap = 0.05;   // [m]
  static constexpr double kStep = 0.01;  // [s]
  ObstacleSet obstacles;
  test::SelfNetwork square;
  CollisionSurface surface;
  std::optional<ObstacleSafeRegions> regions;
};

class ElementOverTop : public ::testing::TestWithParam<Top> {};
INSTANTIATE_TEST_SUITE_P(
    Tops, ElementOverTop,
    ::testing::Values(Top{"ball", SphereGeometry{.radius = 0.5}},
                      Top{"spike", MeshGeometry{std::make_shared<const TriangleMesh>(spikes({Vector3::Zero()})), false}}));

// The tip below the inside of a sliding square stays where it is. The contact's point on the square has to move.
TEST_P(ElementOverTop, HasItsContactAtTheCurrentClosestPoint) {
  constexpr double kGap = SquareAbove::kGap;
  constexpr double kOld = 0.02 * kGap;  // displacement after which closest points are searched again
  constexpr double kSlide = 0.75 * kOld;
  Obstacle obstacle{.name = "top", .geometry = GetParam().geometry};
  if (std::holds_alternative<SphereGeometry>(obstacle.geometry)) obstacle.rest_pose.translation() = Vector3(0.0, -0.5, 0.0);
  SquareAbove above(obstacle, {-0.6, 0.9 * kGap, -0.4});
  Points from = above.square.positions;
  for (int step = 0; step < 200; ++step) {
    Points to = from;
    to.row(0).array() += kSlide;
    const std::vector<Contact> contacts = above.step(from, to);
    ASSERT_FALSE(contacts.empty());
    for (const Contact& contact : contacts) {
      EXPECT_NEAR((element_point(contact, from) - contact.point).cross(contact.normal).norm(), 0.0, kOld) << "step " << step;
    }
    from = to;
  }
}

// The tip moves as its mesh deforms, the square moves half as fast again. The contact is at the tip's end position, and its drift
// is the tip's displacement.
TEST(ElementOverTops, HasAContactThatMovesWithADeformingTip) {
  constexpr double kGap = SquareAbove::kGap;
  constexpr double kStep = SquareAbove::kStep;
  const Vector3 displacement(0.1 * kGap, 0.02 * kGap, 0.0);  // of the tip in a step
  const TriangleMesh first = spikes({Vector3::Zero()});
  MeshSequence sequence{.triangles = first.triangles, .frames = {}, .frame_rate = 1.0 / kStep};
  for (int k = 0; k <= 30; ++k) sequence.frames.emplace_back(first.vertices.colwise() + k * displacement);
  const Obstacle obstacle{.name = "tip",
                          .geometry = SequenceGeometry{std::make_shared<const MeshSequence>(std::move(sequence)), false}};
  SquareAbove above(obstacle, {-0.6, 0.9 * kGap, -0.4});
  Points from = above.square.positions;
  for (int step = 0; step < 30; ++step) {
    const Points to = from.colwise() + Vector3(1.5 * displacement.x(), displacement.y(), 0.0);
    const std::vector<Contact> contacts = above.step(from, to, kStep * (step + 1));
    const auto is_at_tip = [&](const Contact& contact) {
      const Vector3 between = element_point(contact, from) - (contact.point - contact.drift);  // at the begin of the interval
      return contact.point.isApprox((step + 1) * displacement, 1e-9) && contact.drift.isApprox(displacement, 1e-9) &&
             between.cross(contact.normal).norm() < 0.02 * kGap;
    };
    EXPECT_TRUE(std::ranges::any_of(contacts, is_at_tip)) << "step " << step;
    from = to;
  }
}

// The square slides off one tip onto another one, without leaving its region.
TEST(ElementOverTops, HasAContactWithTheNextTipAfterItLeftTheFirst) {
  constexpr double kGap = SquareAbove::kGap;
  const Vector3 next(0.3, -0.1 * kGap, 0.3);
  const Obstacle obstacle{.name = "tops",
                          .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(spikes({Vector3::Zero(), next})), false}};
  SquareAbove above(obstacle, {-0.02, 0.9 * kGap, -0.5});
  const auto touches = [&](const Points& from, const Points& to, const Vector3& tip) {
    const std::vector<Contact> contacts = above.step(from, to);
    return std::ranges::any_of(contacts, [&](const Contact& contact) { return contact.point.isApprox(tip, 1e-12); });
  };
  Points from = above.square.positions;
  EXPECT_TRUE(touches(from, from, Vector3::Zero()));
  for (int step = 0; step < 40; ++step) {
    Points to = from;
    to.row(0).array() += 0.08 * kGap;
    touches(from, to, next);
    from = to;
  }
  EXPECT_TRUE(touches(from, from, next));
}

}  // namespace
}  // namespace sprung
