#include "network/network_builder.h"

#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <limits>

namespace sprung {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> keys(const NetworkBuilder& builder) {
  return problem_keys([&] { return builder.build(); });
}

BodyShape weighed(BodyShape shape) {
  set_total_mass(shape, 1.0);
  return shape;
}

BodyShape small_rope() { return weighed(make_rope({{Vector3(0, 0, 0), Vector3(2, 0, 0)}, 3, std::nullopt}, {stiff(7), {}, {}})); }

TEST(NetworkBuilder, TwoParticlesAndASpringMakeANetwork) {
  NetworkBuilder builder;
  const Index a = builder.add_particle(Vector3(0, 1, 0), 2.0);
  const Index b = builder.add_particle(Vector3(0, 0, 0), 4.0, Vector3(1, 0, 0));
  builder.add_spring(b, a, 10.0, 0.5, 0.1);
  builder.pin(a);
  const SpringNetwork network = builder.build();
  EXPECT_EQ(network.particle_count(), 2);
  EXPECT_EQ(network.positions.col(0), Vector3(0, 1, 0));
  EXPECT_EQ(network.velocities.col(1), Vector3(1, 0, 0));
  EXPECT_EQ(network.masses, Eigen::Vector2d(2, 4));
  EXPECT_EQ(network.inverse_masses, Eigen::Vector2d(0, 0.25));
  EXPECT_EQ(network.drag_areas, Eigen::Vector2d(1, 1));
  EXPECT_TRUE(network.is_fixed(a));
  EXPECT_FALSE(network.is_fixed(b));
  EXPECT_EQ(network.springs.first[0], a) << "the lower index comes first";
  EXPECT_EQ(network.springs.second[0], b);
  EXPECT_EQ(network.springs.stiffness[0], 10.0);
  EXPECT_EQ(network.springs.rest_length[0], 0.5);
  EXPECT_EQ(network.springs.damping[0], 0.1);
  ASSERT_EQ(network.bodies.size(), 1U);
  EXPECT_EQ(network.bodies[0].name, "network");
}

TEST(NetworkBuilder, ASingleParticleIsANetwork) {
  NetworkBuilder builder;
  builder.add_particle(Vector3(1, 2, 3), 1.0);
  const SpringNetwork network = builder.build();
  EXPECT_EQ(network.particle_count(), 1);
  EXPECT_EQ(network.springs.count(), 0);
}

TEST(NetworkBuilder, SpringsWithoutLengthOrStiffnessAreValid) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_spring(0, 1, 0.0, 0.0);
  EXPECT_EQ(builder.build().springs.count(), 1);
}

TEST(NetworkBuilder, SpringsAreSortedWithinABodyAndEqualPairsKeepTheirOrder) {
  NetworkBuilder builder;
  for (int i = 0; i < 4; ++i) builder.add_particle(Vector3(i, 0, 0), 1.0);
  builder.add_spring(3, 1, 1.0, 1.0);
  builder.add_spring(2, 3, 2.0, 1.0);
  builder.add_spring(0, 1, 3.0, 1.0);
  builder.add_spring(1, 0, 4.0, 1.0);
  builder.add_spring(0, 3, 5.0, 1.0);
  builder.add_spring(1, 2, 6.0, 1.0);
  const Springs springs = builder.build().springs;
  EXPECT_THAT(springs.stiffness, ElementsAre(3, 4, 6, 2, 1, 5));
  EXPECT_THAT(springs.first, ElementsAre(0, 0, 1, 2, 1, 0));
  EXPECT_THAT(springs.second, ElementsAre(1, 1, 2, 3, 3, 3));
}

TEST(NetworkBuilder, BodiesAreRangesOfParticlesAndSprings) {
  NetworkBuilder builder;
  const ContactMaterial material{0.01, 0.2, 0.3, 0.5};
  EXPECT_EQ(builder.add_body("left", small_rope()), 0);
  EXPECT_EQ(builder.add_body("right", small_rope(), material), 3);
  builder.begin_body("loose");
  EXPECT_EQ(builder.add_particle(Vector3::Zero(), 1.0), 6);
  const SpringNetwork network = builder.build();
  ASSERT_EQ(network.bodies.size(), 3U);
  const Body& right = network.bodies[1];
  EXPECT_EQ(right.first_particle, 3);
  EXPECT_EQ(right.particle_count, 3);
  EXPECT_EQ(right.first_spring, 2);
  EXPECT_EQ(right.spring_count, 2);
  EXPECT_EQ(right.material.restitution, 0.5);
  EXPECT_EQ(right.surface.segments.maxCoeff(), 2) << "surface indices count within the body";
  EXPECT_THAT(network.springs.first, ElementsAre(0, 1, 3, 4));
  EXPECT_EQ(network.body_of(0).name, "left");
  EXPECT_EQ(network.body_of(2).name, "left");
  EXPECT_EQ(network.body_of(3).name, "right");
  EXPECT_EQ(network.body_of(6).name, "loose");
}

TEST(NetworkBuilder, AWholeBodyAcceptsFurtherSprings) {
  NetworkBuilder builder;
  builder.add_body("first", small_rope());
  const Index first = builder.add_body("second", small_rope());
  builder.add_spring(first, first + 2, 9.0, 2.0, 0.0, SpringKind::bend);
  const SpringNetwork network = builder.build();
  EXPECT_EQ(network.bodies[1].spring_count, 3);
  EXPECT_EQ(network.springs.first[4], 3);
  EXPECT_EQ(network.springs.second[4], 5);
}

// A pinned particle with a velocity would drag its neighbours along by their dampers.
TEST(NetworkBuilder, APinnedParticleHasNoInitialVelocity) {
  NetworkBuilder builder;
  const Index pinned = builder.add_particle(Vector3::Zero(), 1.0, Vector3(4, 5, 6));
  const Index free = builder.add_particle(Vector3::UnitX(), 1.0, Vector3(4, 5, 6));
  builder.pin(pinned);
  const SpringNetwork network = builder.build();
  EXPECT_EQ(network.velocities.col(pinned), Vector3::Zero());
  EXPECT_EQ(network.velocities.col(free), Vector3(4, 5, 6));
}

TEST(NetworkBuilder, RejectsANetworkWithoutParticles) {
  EXPECT_THAT(keys({}), ElementsAre("particles"));
  NetworkBuilder builder;
  builder.begin_body("empty");
  EXPECT_THAT(keys(builder), UnorderedElementsAre("particles", "bodies.empty"));
}

TEST(NetworkBuilder, RejectsInvalidMassesPositionsAndVelocities) {
  for (const double mass : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    NetworkBuilder builder;
    builder.add_particle(Vector3::Zero(), mass);
    EXPECT_THAT(keys(builder), ElementsAre("bodies.network.masses[0]"));
  }
  NetworkBuilder builder;
  builder.add_particle(Vector3(0, kNan, 0), 1.0, Vector3(0, 0, kNan));
  EXPECT_THAT(keys(builder), UnorderedElementsAre("bodies.network.positions[0]", "bodies.network.velocities[0]"));
}

TEST(NetworkBuilder, NamesTheFirstOfManyProblemsAndCountsTheOthers) {
  NetworkBuilder builder;
  builder.add_body("cloth", make_cloth({{1, 1}, {100, 100}}, {}));
  try {
    static_cast<void>(builder.build());
    FAIL() << "a cloth without mass";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].key, "bodies.cloth.masses[0]");
    EXPECT_EQ(error.problems()[0].value, "0 (and 9999 more)");
  }
}

TEST(NetworkBuilder, RejectsSpringsThatDoNotJoinTwoParticlesOfOneBody) {
  const auto with_spring = [](Index i, Index j) {
    NetworkBuilder builder;
    builder.add_particle(Vector3::Zero(), 1.0);
    builder.add_particle(Vector3::Ones(), 1.0);
    builder.begin_body("other");
    builder.add_particle(Vector3::Ones(), 1.0);
    builder.add_spring(i, j, 1.0, 1.0);
    return keys(builder);
  };
  EXPECT_THAT(with_spring(0, 1), ElementsAre());
  EXPECT_THAT(with_spring(0, 2), ElementsAre("springs[0]")) << "another body";
  EXPECT_THAT(with_spring(0, 3), ElementsAre("springs[0]")) << "no particle";
  EXPECT_THAT(with_spring(-1, 1), ElementsAre("springs[0]")) << "no particle";
  EXPECT_THAT(with_spring(1, 1), ElementsAre("bodies.network.springs[0]")) << "itself";
}

TEST(NetworkBuilder, RejectsNegativeAndNonFiniteQuantities) {
  for (const double bad : {-1.0, kNan, std::numeric_limits<double>::infinity()}) {
    NetworkBuilder builder;
    builder.add_particle(Vector3::Zero(), 1.0);
    builder.add_particle(Vector3::Ones(), 1.0);
    builder.add_spring(0, 1, 1.0, 1.0);
    builder.add_spring(0, 1, bad, bad, bad);
    EXPECT_THAT(keys(builder), UnorderedElementsAre("bodies.network.springs.rest_length[1]", "bodies.network.springs.stiffness[1]",
                                                    "bodies.network.springs.damping[1]"));
  }
}

TEST(NetworkBuilder, RejectsShapesWithArraysOfDifferentLengths) {
  BodyShape short_of_mass = small_rope();
  short_of_mass.masses.pop_back();
  NetworkBuilder builder;
  builder.add_body("rope", short_of_mass);
  EXPECT_THAT(keys(builder), ElementsAre("bodies.rope"));

  BodyShape wrong_surface = small_rope();
  wrong_surface.surface.segments(1, 1) = 3;
  NetworkBuilder other;
  other.add_body("rope", wrong_surface);
  EXPECT_THAT(keys(other), ElementsAre("bodies.rope.surface"));
}

TEST(NetworkBuilder, RejectsBodiesOfOneName) {
  NetworkBuilder builder;
  builder.add_body("rope", small_rope());
  builder.add_body("rope", small_rope());
  builder.add_body("rope", small_rope());
  EXPECT_THAT(keys(builder), ElementsAre("bodies.rope"));
  NetworkBuilder unnamed;
  unnamed.add_body("", small_rope());
  EXPECT_THAT(keys(unnamed), ElementsAre("bodies."));
}

TEST(NetworkBuilder, RejectsSpringsThatBreakInClosedBodies) {
  SpringMaterial material = stiff(1.0);
  material.break_strain = 0.5;
  const BodyShape solid = weighed(make_solid({.size = {1, 1, 1}, .resolution = {2, 2, 2}}, {.structural = material}));
  const BodyShape open = weighed(make_cloth({.size = {1, 1}, .resolution = {2, 2}}, {.structural = material}));
  BodyShape filled = open;
  filled.pressure = 1.0;
  BodyShape kept = open;
  kept.volume_factor = 1.0;
  NetworkBuilder builder;
  builder.add_body("solid", solid);
  builder.add_body("open", open);
  builder.add_body("filled", filled);
  builder.add_body("kept", kept);
  EXPECT_THAT(keys(builder), ElementsAre("bodies.solid.springs.break", "bodies.filled.springs.break", "bodies.kept.springs.break"));
}

TEST(NetworkBuilder, RejectsContactMaterialsOutOfRange) {
  NetworkBuilder builder;
  builder.begin_body("ball", {-0.1, 0.5, 0.4, 1.5});
  builder.add_particle(Vector3::Zero(), 1.0);
  EXPECT_THAT(keys(builder),
              UnorderedElementsAre("bodies.ball.thickness", "bodies.ball.static_friction", "bodies.ball.restitution"));
  NetworkBuilder undefined;
  undefined.begin_body("ball", {kNan, kNan, kNan, kNan});
  undefined.add_particle(Vector3::Zero(), 1.0);
  EXPECT_THAT(keys(undefined), UnorderedElementsAre("bodies.ball.thickness", "bodies.ball.friction", "bodies.ball.static_friction",
                                                    "bodies.ball.restitution"));
}

TEST(NetworkBuilder, RejectsEmptyPinsAndParticlesPinnedTwice) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.pin(0);
  builder.pin(std::vector<Index>{});
  builder.pin({1, -1});
  builder.pin(0);
  EXPECT_THAT(keys(builder), ElementsAre("pins[1]", "pins[2]", "pins[2]", "pins[3]"));
}

// Their forces are reported by name.
TEST(NetworkBuilder, RejectsPinsAndAttachmentsOfOneName) {
  NetworkBuilder builder;
  for (int i = 0; i < 4; ++i) builder.add_particle(Vector3(i, 0, 0), 1.0);
  builder.add_pin({.particles = {0}, .motion = {}, .name = "hook"});
  builder.add_pin({.particles = {1}, .motion = {}, .name = "hook"});
  builder.pin(2);
  builder.add_attachment({.name = "pins[2]", .particles = {2}, .second = ParticleEnds{{3}}});
  builder.add_attachment({.name = "hook", .particles = {0}, .second = ParticleEnds{{3}}});
  EXPECT_THAT(keys(builder), ElementsAre("pins[1].name", "attachments[0].name", "attachments[1].name"));
}

TEST(NetworkBuilder, PinsHoldAParticleOneAfterTheOther) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 2.0, Vector3(1, 2, 3));
  builder.add_pin({.particles = {0}, .motion = {}, .from = 1.0, .until = 2.0});
  builder.add_pin({.particles = {0}, .motion = {}, .from = 3.0});
  builder.add_pin({.particles = {0}, .motion = {}, .from = 2.0, .until = 3.0});
  const SpringNetwork network = builder.build();
  EXPECT_EQ(network.activity.phases, std::vector<PinPhase>(3, PinPhase::waiting));
  EXPECT_EQ(network.inverse_masses[0], 0.5);
  EXPECT_EQ(network.velocities.col(0), Vector3(1, 2, 3));
  builder.add_pin({.particles = {0}, .motion = {}, .from = 2.5, .until = 2.75});
  EXPECT_THAT(keys(builder), ElementsAre("pins[3]"));
}

TEST(NetworkBuilder, PinsThatEndBeforeTheyBeginAreProblems) {
  NetworkBuilder builder;
  for (int i = 0; i < 5; ++i) builder.add_particle(Vector3::Zero(), 1.0);
  builder.add_pin({.particles = {0}, .motion = {}, .from = 2.0, .until = 1.0});
  builder.add_pin({.particles = {1}, .motion = {}, .from = 2.0, .until = 2.0});
  builder.add_pin({.particles = {2}, .motion = {}, .from = -1.0});
  builder.add_pin({.particles = {3}, .motion = {}, .from = kNan});
  builder.add_pin({.particles = {4}, .motion = {}, .until = kNan});
  EXPECT_THAT(keys(builder),
              ElementsAre("pins[0].until", "pins[1].until", "pins[2].from", "pins[3].from", "pins[3].until", "pins[4].until"));
}

TEST(NetworkBuilder, RejectsInvalidMotions) {
  NetworkBuilder builder;
  for (int i = 0; i < 3; ++i) builder.add_particle(Vector3::Zero(), 1.0);
  Motion backwards;
  backwards.keyframes.resize(3);
  backwards.keyframes[1].time = 1.0;
  backwards.keyframes[2].time = 1.0;
  builder.pin(0, backwards);
  Motion undefined;
  undefined.keyframes.resize(1);
  undefined.keyframes[0].time = kNan;
  undefined.spin = Vector3(0, kNan, 0);
  builder.pin(1, undefined);
  builder.pin(2, {}, Vector3(kNan, 0, 0));
  EXPECT_THAT(keys(builder), UnorderedElementsAre("pins[0].motion.keyframes[2]", "pins[1].motion.keyframes[0]",
                                                  "pins[1].motion.spin", "pins[2].origin"));
}

}  // namespace
}  // namespace sprung
