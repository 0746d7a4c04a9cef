#include "collision/obstacle_zones.h"

#include "collision/sample_meshes.h"
#include "collision/self_networks.h"
#include "collision/single_particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace sprung {
namespace {

// Obstacles are looked for where elements are about to go. What is elsewhere has no zones, and nothing may be led there.
TEST(ObstacleZones, AllowNoPlaceWhereNoObstacleWasLookedFor) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.5}};
  ball.placed.translation() = Vector3(10.0, 0.0, 0.0);
  Environment environment({ball});
  environment.set_interval(0.0, 0.01);
  const CollisionSurface surface = test::particle_surface({0});
  const Points here = Points::Zero(3, 1);
  ObstacleZones zones(environment.set(), surface, here, 0.01);
  zones.follow({here, here});
  std::vector<HalfSpace> half_spaces;
  zones.append_half_spaces(0, half_spaces);
  const auto is_within = [&](const Vector3& p) {
    return std::ranges::all_of(half_spaces, [&](const HalfSpace& bound) { return bound.normal.dot(p) >= bound.offset; });
  };
  EXPECT_TRUE(zones.allow(0, here.col(0)));
  EXPECT_TRUE(is_within(here.col(0)));
  EXPECT_FALSE(zones.allow(0, ball.placed.translation()));
  EXPECT_FALSE(is_within(ball.placed.translation()));
}

// A zone that is made again because one of its corners leaves has other planes, which may not hold another corner on its way
// although its old zone did: that one has to be looked at too. A cloth moves at random over rough ground; whoever is not restless
// goes where it wants.
TEST(ObstacleZones, WhomNewZonesDoNotHoldIsRestless) {
  constexpr Index kSide = 10;
  constexpr int kSteps = 1000;
  constexpr double kFarthest = 0.1;
  test::Random random(1);
  const TriangleMesh ground = test::terrain(12, [&](Index, Index) { return random.between(0.0, 1.0); });
  const Obstacle obstacle{.name = "ground", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(ground), false}};
  Environment environment({obstacle});
  environment.set_interval(0.0, 0.01);
  test::SelfNetwork cloth;
  cloth.add_cloth(kSide, {-4.0, 1.1, -4.0}, {0.8, 0.0, 0.0}, {0.0, 0.0, 0.8});
  const CollisionSurface surface = cloth.surface(0.05);
  ObstacleZones zones(environment.set(), surface, cloth.positions, 0.05);
  Points from = cloth.positions;
  for (int step = 0; step < kSteps; ++step) {
    Points to = from;
    for (Index i = 0; i < cloth.count(); ++i) {
      to.col(i) += random.between(0.0, kFarthest) * random.direction() - Vector3(0.0, 0.2 * kFarthest, 0.0);
    }
    zones.follow({from, to});
    const std::vector<Index> restless = zones.restless();
    for (Index i = 0; i < cloth.count(); ++i) {
      if (std::ranges::binary_search(restless, i)) continue;
      ASSERT_TRUE(zones.allow(i, to.col(i))) << "particle " << i << " in step " << step;
      from.col(i) = to.col(i);
    }
  }
}

}  // namespace
}  // namespace sprung
