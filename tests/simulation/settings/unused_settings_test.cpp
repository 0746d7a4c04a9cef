#include "simulation/settings/settings_check.h"

#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using testing::ground;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Particles of these materials, a body each: "a", "b" and so on.
SpringNetwork particles(const std::vector<ContactMaterial>& materials, const BodyContact& contact = {.others = false}) {
  NetworkBuilder builder;
  for (std::size_t k = 0; k < materials.size(); ++k) {
    builder.begin_body(std::string(1, static_cast<char>('a' + k)), materials[k], contact);
    builder.add_particle({static_cast<double>(k), 1.0, 0.0}, 0.1);
  }
  return builder.build();
}

SimulatorSettings penalty() {
  return {.contact = {.response = ContactSettings::Response::penalty, .stiffness = 1000.0, .damping = 1.0}};
}

ContactMaterial rough(double friction) { return {.thickness = 0.01, .friction = friction, .static_friction = friction}; }

TEST(UnusedSettings, AStretchLimitLeavesOutSpringsThatFail) {
  const auto warnings = [](const SpringLaw& law, const StretchLimitSettings& limit) {
    NetworkBuilder builder;
    builder.begin_body("string");
    for (const double x : {0.0, 1.0}) builder.add_particle({x, 0.0, 0.0}, 0.1);
    builder.add_spring(0, 1, 100.0, 1.0, 0.0, SpringKind::structural, law);
    return unused_settings({.stretch_limit = limit}, builder.build(), {});
  };
  EXPECT_THAT(warnings({.yield = 0.1}, {}), ElementsAre(HasSubstr("body \"string\": the stretch limit leaves out")));
  EXPECT_THAT(warnings({.break_length = 2.0}, {}), ElementsAre(HasSubstr("the stretch limit leaves out")));
  EXPECT_THAT(warnings({.break_length = 2.0}, {.of_materials = true}), IsEmpty());
  EXPECT_THAT(warnings({.tension_only = true}, {.max_compression = 0.5}), ElementsAre(HasSubstr("max_compression pushes")));
  EXPECT_THAT(warnings({.tension_only = true}, {}), IsEmpty());
}

TEST(UnusedSettings, APenaltyNeedsAThickness) {
  const std::vector<Obstacle> hard{ground()};
  EXPECT_THAT(
      unused_settings(penalty(), particles({{}, {}, {}, {.thickness = 0.01}}), hard),
      ElementsAre(HasSubstr("bodies \"a\", \"b\" and 1 more: the penalty of contact has no effect before obstacle \"ground\"")));
  EXPECT_THAT(unused_settings(penalty(), particles({{}}), {ground({.thickness = 0.01})}), IsEmpty());
  EXPECT_THAT(unused_settings({}, particles({{}}), hard), IsEmpty());
  EXPECT_THAT(unused_settings(penalty(), particles({{}}), {}), IsEmpty());
}

TEST(UnusedSettings, APenaltyActsOnlyBeforeObstacles) {
  const ContactMaterial thick{.thickness = 0.01};
  EXPECT_THAT(unused_settings(penalty(), particles({thick, thick}, {.others = true}), {}),
              ElementsAre(HasSubstr("bodies pass through each other")));
  EXPECT_THAT(unused_settings(penalty(), particles({thick}, {.others = true}), {}), IsEmpty());
}

TEST(UnusedSettings, APenaltyHasNoRestitutionAndOneFriction) {
  const ContactMaterial bouncing{.thickness = 0.01, .restitution = 0.5};
  ContactMaterial sticky = rough(0.2);
  sticky.static_friction = 0.3;
  EXPECT_THAT(unused_settings(penalty(), particles({bouncing}), {ground()}),
              ElementsAre(HasSubstr("body \"a\": restitution has no effect with penalty")));
  EXPECT_THAT(unused_settings(penalty(), particles({rough(0.2)}), {ground(sticky)}),
              ElementsAre(HasSubstr("obstacle \"ground\": static_friction has no effect with penalty")));
  EXPECT_THAT(unused_settings({}, particles({bouncing}), {ground(bouncing)}), IsEmpty());
}

TEST(UnusedSettings, DragOfFacesNeedsFaces) {
  const SimulatorSettings settings{.air_surface = {.normal = 1.0}};
  EXPECT_THAT(unused_settings(settings, particles({{}}), {}),
              ElementsAre(HasSubstr("air.surface has no effect: it acts on faces")));
  EXPECT_THAT(unused_settings(settings, testing::cloth(2, 0.0), {}), IsEmpty());
}

TEST(UnusedSettings, QuadraticDragNeedsCoefficients) {
  EXPECT_THAT(unused_settings({.air_surface = {.quadratic = true}}, testing::cloth(2, 0.0), {}),
              ElementsAre(HasSubstr("air.surface has no effect: its coefficients are 0")));
  EXPECT_THAT(unused_settings({.air_surface = {.tangential = 0.1, .quadratic = true}}, testing::cloth(2, 0.0), {}), IsEmpty());
}

TEST(UnusedSettings, WindAndGustsNeedDrag) {
  const Wind wind({{0.0, Vector3::UnitX()}}, Gusts{.speed = 1.0});
  EXPECT_THAT(unused_settings({.wind = wind}, testing::cloth(2, 0.0), {}),
              ElementsAre(HasSubstr("air.wind has no effect"), HasSubstr("air.gusts has no effect")));
  EXPECT_THAT(unused_settings({.wind = Wind({}, Gusts{.speed = 1.0})}, testing::cloth(2, 0.0), {}),
              ElementsAre(HasSubstr("air.gusts has no effect here")));
  EXPECT_THAT(unused_settings({.air_drag = 0.1, .wind = wind}, testing::cloth(2, 0.0), {}), IsEmpty());
  EXPECT_THAT(unused_settings({.air_surface = {.normal = 1.0}, .wind = wind}, testing::cloth(2, 0.0), {}), IsEmpty());
}

TEST(UnusedSettings, FrictionNeedsBothSides) {
  EXPECT_THAT(unused_settings({}, particles({rough(0.5)}), {ground()}),
              ElementsAre(HasSubstr("body \"a\": friction has no effect")));
  EXPECT_THAT(unused_settings({}, particles({{}}), {ground(rough(0.5))}),
              ElementsAre(HasSubstr("obstacle \"ground\": friction has no effect")));
  EXPECT_THAT(unused_settings({}, particles({rough(0.5)}), {ground(), ground(rough(0.1))}), IsEmpty());
  EXPECT_THAT(unused_settings({}, particles({rough(0.5)}), {}), IsEmpty()) << "it can touch nothing";
}

TEST(UnusedSettings, FrictionActsBetweenBodiesThatCollide) {
  EXPECT_THAT(unused_settings({}, particles({rough(0.5), rough(0.5)}, {.others = true}), {ground()}), IsEmpty());
  EXPECT_THAT(unused_settings({}, particles({rough(0.5), {}}, {.others = true}), {}),
              ElementsAre(HasSubstr("body \"a\": friction")));
  EXPECT_THAT(unused_settings({}, particles({rough(0.5)}, {.self = true}), {ground()}), IsEmpty());
}

TEST(UnusedSettings, TethersNeedPins) {
  const SimulatorSettings tethered{.stretch_limit = StretchLimitSettings{.tethers = true}};
  NetworkBuilder builder;
  const Index a = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  builder.add_spring(a, builder.add_particle({1.0, 0.0, 0.0}, 1.0), 1.0, 1.0, 0.0);
  EXPECT_THAT(unused_settings(tethered, builder.build(), {}), ElementsAre(HasSubstr("tethers has no effect without pins")));
  builder.pin(a, {});
  EXPECT_THAT(unused_settings(tethered, builder.build(), {}), IsEmpty());
}

}  // namespace
}  // namespace sprung
