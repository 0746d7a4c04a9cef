#include "dynamics/contact/contact_materials.h"

#include "network/network_builder.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

const ContactMaterial kFirst{.thickness = 0.02, .friction = 0.2, .static_friction = 0.4, .restitution = 0.1};
const ContactMaterial kSecond{.thickness = 0.04, .friction = 0.8, .static_friction = 0.9, .restitution = 0.7};

TEST(ContactMaterials, GapIsTheSumWithAnObstacleAndTheMeanBetweenBodies) {
  EXPECT_DOUBLE_EQ(combine(kFirst, kSecond).thickness, 0.06);
  EXPECT_DOUBLE_EQ(combine_bodies(kFirst, kSecond).thickness, 0.03);
  for (const ContactMaterial& pair : {combine(kFirst, kSecond), combine_bodies(kSecond, kFirst)}) {
    EXPECT_DOUBLE_EQ(pair.friction, 0.4);
    EXPECT_DOUBLE_EQ(pair.static_friction, 0.6);
    EXPECT_EQ(pair.restitution, 0.7);
  }
}

TEST(ContactMaterials, ContactsCombineTheMaterialsOfTheirSides) {
  NetworkBuilder builder;
  builder.begin_body("first", kFirst);
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.begin_body("second", kSecond);
  for (int i = 0; i < 3; ++i) builder.add_particle(Vector3::Zero(), 1.0);
  const SpringNetwork network = builder.build();
  const std::vector<Obstacle> obstacles{{.name = "floor", .geometry = HalfSpaceGeometry{}, .material = {.thickness = 0.5}}};
  const ContactMaterials materials(network, obstacles);
  ContactMaterials::Last last;

  EXPECT_EQ(materials.of(particle_contact(0, 0, Vector3::Zero(), Vector3::UnitY()), last).thickness, 0.52);
  EXPECT_EQ(materials.of(particle_contact(2, 0, Vector3::Zero(), Vector3::UnitY()), last).thickness, 0.54);
  Contact pair;
  pair.particles = {0, 1, 2, kNone};
  pair.weights = {1.0, -0.5, -0.5, 0.0};
  pair.count = 3;
  EXPECT_DOUBLE_EQ(materials.of(pair, last).thickness, 0.03);
  EXPECT_DOUBLE_EQ(materials.of(pair, last).thickness, 0.03) << "again the same";
  pair.particles = {3, 1, 2, kNone};
  EXPECT_DOUBLE_EQ(materials.of(pair, last).thickness, 0.04) << "a body and itself";
}

}  // namespace
}  // namespace sprung
