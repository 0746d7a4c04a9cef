#include "network/damping_ratio.h"

#include "geometry/mesh/polygon_mesh.h"
#include "network/network_builder.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace sprung {
namespace {

using namespace testing;
using ::testing::Each;
using ::testing::ElementsAre;

SpringMaterial ratio(double stiffness, double damping_ratio) {
  return {stiffness, SpringMaterial::Measure::stiffness, 0.0, damping_ratio};
}

/// Two particles of `mass` [kg] each, 1 m apart, joined by k_s = 8 N/m with a damping ratio of 0.25.
SpringNetwork damped_pair(double mass, bool pinned) {
  BodyShape shape = make_rope({{Vector3::Zero(), Vector3::UnitY()}, 2, std::nullopt}, {.structural = ratio(8.0, 0.25)});
  set_total_mass(shape, 2.0 * mass);
  NetworkBuilder builder;
  builder.add_body("pair", shape);
  if (pinned) builder.pin(0);
  return builder.build();
}

TEST(DampingRatio, OfAPairUsesTheReducedMass) {
  // 2 zeta sqrt(k m): the reduced mass is m / 2 of two free particles, and m if one is pinned.
  EXPECT_DOUBLE_EQ(damped_pair(4.0, false).springs.damping[0], 2.0 * 0.25 * std::sqrt(8.0 * 2.0));
  EXPECT_DOUBLE_EQ(damped_pair(2.0, true).springs.damping[0], 2.0 * 0.25 * std::sqrt(8.0 * 2.0));
}

TEST(DampingRatio, BreathingFrequencyOfARopeHasItsClosedForm) {
  // EA L / integral of density s^2 ds: 12 c^2 / L^2 about the middle, 3 c^2 / L^2 about an end, c^2 = EA / density. The error of
  // the sum over n cells is at most 1 / n^2.
  for (const bool pinned : {false, true}) {
    BodyShape shape = make_rope({{Vector3::Zero(), Vector3(2, 0, 0)}, 101, std::nullopt}, {.structural = modular(50.0)});
    set_density(shape, 0.5);
    NetworkBuilder builder;
    builder.add_body("rope", shape);
    if (pinned) builder.pin(100);
    const SpringNetwork network = builder.build();
    const double expected = std::sqrt((pinned ? 3.0 : 12.0) * 50.0 / 0.5) / 2.0;
    EXPECT_NEAR(breathing_frequency(network, network.bodies[0]), expected, 2e-4 * expected);
  }
}

TEST(DampingRatio, AppliesOnlyToItsKindOfSpringAndItsBody) {
  const BodyShape plain = [] {
    BodyShape shape = make_cloth({}, {.structural = SpringMaterial{.value = 5.0, .damping = 0.3}, .shear = ratio(2.0, 0.1)});
    set_total_mass(shape, 1.0);
    return shape;
  }();
  NetworkBuilder builder;
  builder.add_body("one", plain);
  const SpringNetwork alone = builder.build();
  builder.begin_body("two");
  const Index a = builder.add_particle(Vector3(5, 0, 0), 100.0);
  const Index b = builder.add_particle(Vector3(9, 0, 0), 100.0);
  builder.add_spring(a, b, 7.0, 4.0, 0.5);
  const SpringNetwork network = builder.build();
  const double omega = breathing_frequency(alone, alone.bodies[0]);
  for (Index s = 0; s < alone.springs.count(); ++s) {
    const double expected = alone.springs.kind[s] == SpringKind::shear ? 2.0 * 0.1 * 2.0 / omega : 0.3;
    EXPECT_EQ(alone.springs.damping[s], expected);
    EXPECT_EQ(network.springs.damping[s], expected);
  }
  EXPECT_EQ(network.springs.damping.back(), 0.5);
}

TEST(DampingRatio, DampsNothingInABodyWithoutExtent) {
  BodyShape shape = make_rope({{Vector3::Zero(), Vector3(0, 0, 1e-3)}, 2, 1.0}, {.structural = ratio(8.0, 0.25)});
  shape.positions[1] = shape.positions[0];
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("point", shape);
  EXPECT_EQ(builder.build().springs.damping[0], 0.0);
}

TEST(DampingRatio, IsRefusedTogetherWithDampingWithoutStiffnessAndBelowZero) {
  const auto refused = [](const SpringMaterial& material) {
    return problem_keys([&] { return make_cloth({}, {.bend = material}); });
  };
  EXPECT_THAT(refused({1.0, SpringMaterial::Measure::modulus, 0.1, 0.1}), ElementsAre("springs.bend.damping_ratio"));
  EXPECT_THAT(refused(ratio(0.0, 0.1)), ElementsAre("springs.bend.damping_ratio"));
  EXPECT_THAT(refused(ratio(1.0, -0.1)), ElementsAre("springs.bend.damping_ratio"));
}

// k_d = damping_time * k_s. The damping time is a power of two, so that the product is exact.
TEST(DampingTime, IsTheRatioOfDampingToStiffness) {
  const SpringMaterial damped{.value = 40.0, .measure = SpringMaterial::Measure::modulus, .damping_time = 0.25};
  SpringMaterials materials = every_kind(damped);
  const BodyShape solid = make_solid({.size = {1.0, 2.0, 3.0}, .resolution = {3, 4, 3}}, materials);
  PolygonMesh square;
  square.vertices = (Points(3, 4) << 0, 3, 3, 0, 0, 0, 2, 2, 0, 0, 0, 0).finished();
  square.faces = to_polygons((Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished());
  const BodyShape mesh = make_mesh_body(square, materials);
  materials.bend_model = SpringMaterials::BendModel::angle;
  const BodyShape cloth = make_cloth({.size = {1.0, 2.0}, .resolution = {4, 6}}, materials);
  EXPECT_GT(cloth.angle_bends.count(), 0);
  for (const BodyShape* shape : {&solid, &mesh, &cloth}) {
    EXPECT_GT(shape->springs.count(), 0);
    for (Index s = 0; s < shape->springs.count(); ++s) EXPECT_EQ(shape->springs.damping[s], 0.25 * shape->springs.stiffness[s]);
    for (Index e = 0; e < shape->angle_bends.count(); ++e)
      EXPECT_EQ(shape->angle_bends.damping[e], 0.25 * shape->angle_bends.stiffness[e]);
  }
}

TEST(Density, GivesEachParticleTheMassOfTheRegionNearestToIt) {
  BodyShape cloth = make_cloth({.size = {2.0, 4.0}, .resolution = {3, 3}}, {});
  set_density(cloth, 3.0);
  // Cells of 1 m x 2 m: 6 kg inside, half of it on an edge, a quarter in a corner.
  EXPECT_THAT(cloth.masses, ElementsAre(1.5, 3.0, 1.5, 3.0, 6.0, 3.0, 1.5, 3.0, 1.5));
  BodyShape solid = make_solid({.size = Vector3(2, 2, 2), .resolution = {2, 2, 2}}, {});
  set_density(solid, 5.0);
  EXPECT_THAT(solid.masses, Each(5.0));
  BodyShape rope = make_rope({{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(2, 1, 0)}, std::nullopt, std::nullopt}, {});
  set_density(rope, 4.0);
  EXPECT_THAT(rope.masses, ElementsAre(4.0, 6.0, 2.0));
}

TEST(Density, OfAMeshIsSharedByItsFacesOrLines) {
  PolygonMesh square;
  square.vertices = (Points(3, 4) << 0, 3, 3, 0, 0, 0, 2, 2, 0, 0, 0, 0).finished();
  square.faces = to_polygons((Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished());
  BodyShape cloth = make_mesh_body(square, {});
  set_density(cloth, 2.0);
  // A third of 2 kg/m^2 times 3 m^2 for each corner of a triangle.
  EXPECT_THAT(cloth.masses, ElementsAre(4.0, 2.0, 4.0, 2.0));
  square.faces = PolygonFaces{};
  square.lines = (Edges(2, 2) << 0, 1, 1, 2).finished();
  EXPECT_THAT(problem_keys([&] {
                BodyShape shape = make_mesh_body(square, {});
                set_density(shape, 2.0);
                return shape;
              }),
              ElementsAre("density"))
      << "vertex 3 is in no line";
  square.vertices.conservativeResize(3, 3);
  BodyShape rope = make_mesh_body(square, {});
  set_density(rope, 2.0);
  EXPECT_THAT(rope.masses, ElementsAre(3.0, 5.0, 2.0));
}

TEST(Density, MustBePositive) {
  BodyShape cloth = make_cloth({}, {});
  for (const double density : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(problem_keys([&] {
                  set_density(cloth, density);
                  return cloth;
                }),
                ElementsAre("density"));
  }
}

}  // namespace
}  // namespace sprung
