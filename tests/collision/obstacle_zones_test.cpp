#include "collision/obstacle_zones.h"

#include "collision/single_particles.h"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace sprung
