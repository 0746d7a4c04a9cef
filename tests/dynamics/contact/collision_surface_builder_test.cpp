#include "dynamics/contact/collision_surface_builder.h"

#include "dynamics/networks.h"
#include "network/model/activity.h"
#include "network/set_asleep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

using ::testing::ElementsAre;

Index elements_with(const CollisionSurface& surface, Index body, int corners) {
  return static_cast<Index>(std::count_if(surface.elements.begin(), surface.elements.end(), [&](const Element& element) {
    return element.body == body && element.corners == corners;
  }));
}

BodyShape weighed(BodyShape shape) {
  set_total_mass(shape, 1.0);
  return shape;
}

TEST(ContactSurface, ClothsGiveTrianglesRopesSegmentsAndSolidsTheirSurfaceAndInside) {
  NetworkBuilder builder;
  builder.add_body("cloth", weighed(make_cloth({.resolution = {3, 4}}, {})), {.thickness = 0.01}, {.self = true});
  builder.add_body("rope", weighed(make_rope({{Vector3::Zero(), Vector3::UnitX()}, 5, {}}, {})), {.thickness = 0.02},
                   {.others = false});
  builder.add_body("jelly", weighed(make_solid({.resolution = {4, 4, 4}}, {})));
  builder.begin_body("dust");
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.pin({0, 12});
  const SpringNetwork network = builder.build();
  const CollisionSurface surface = contact_surface(network);

  EXPECT_EQ(elements_with(surface, 0, 3), 2 * 2 * 3);
  EXPECT_EQ(elements_with(surface, 1, 2), 4);
  EXPECT_EQ(elements_with(surface, 2, 3), 6 * 2 * 3 * 3);
  EXPECT_EQ(elements_with(surface, 2, 1), 2 * 2 * 2);
  EXPECT_EQ(elements_with(surface, 3, 1), 1);
  for (const Element& element : surface.elements) {
    for (int k = 0; k < element.corners; ++k) {
      const Index particle = element.particles[static_cast<std::size_t>(k)];
      EXPECT_EQ(&network.body_of(particle), &network.bodies[static_cast<std::size_t>(element.body)]);
    }
  }
  EXPECT_EQ(surface.thickness[11], 0.01);
  EXPECT_EQ(surface.thickness[12], 0.02);
  EXPECT_TRUE(is_fixed(surface.motions, 0) && is_fixed(surface.motions, 12));
  EXPECT_EQ(std::ranges::count(surface.motions, ParticleMotion::free), network.particle_count() - 2);
  EXPECT_THAT(surface.self, ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(surface.others, ElementsAre(1, 0, 1, 1));
}

TEST(ParticleMotions, PinsThatMoveDriveWhatDoesNotSleep) {
  NetworkBuilder builder;
  for (int i = 0; i < 4; ++i) builder.add_particle(Vector3(i, 0.0, 0.0), 1.0);
  builder.pin(1, {.keyframes = {}, .spin = Vector3::UnitY()});
  builder.pin(2);
  const Pin later{.particles = {0}, .motion = {.keyframes = {}, .spin = Vector3::UnitY()}, .from = 1.0};
  builder.add_pin(later);
  SpringNetwork network = builder.build();
  constexpr auto kFree = ParticleMotion::free;
  constexpr auto kDriven = ParticleMotion::driven;
  constexpr auto kAtRest = ParticleMotion::at_rest;
  EXPECT_THAT(particle_motions(network), ElementsAre(kFree, kDriven, kAtRest, kFree)) << "a pin that has not begun drives nothing";
  set_asleep({0, 0, 0, 1}, network);
  EXPECT_THAT(particle_motions(network), ElementsAre(kFree, kDriven, kAtRest, kAtRest));
}

}  // namespace
}  // namespace sprung
