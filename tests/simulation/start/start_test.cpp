#include "base/error.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace sprung {
namespace {

using ::testing::AllOf;
using testing::cloth;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Ge;
using testing::ground;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSubsetOf;
using testing::one_particle;
using testing::sheet;
using ::testing::SizeIs;

Obstacle ball(double radius, const Vector3& position) {
  Obstacle result{.name = "ball", .geometry = SphereGeometry{radius}};
  result.rest_pose.translation() = position;
  return result;
}

/// The problems with which the simulation is refused; empty if it is accepted.
std::vector<std::string> refusal(const SpringNetwork& network, const SimulatorSettings& settings,
                                 const std::vector<Obstacle>& obstacles) {
  try {
    const Simulator simulator(network, settings, obstacles);
    return {};
  } catch (const InputError& error) {
    std::vector<std::string> lines;
    for (const Problem& problem : error.problems()) lines.push_back(to_string(problem));
    return lines;
  }
}

TEST(Start, ABodyInAnObstacleIsReportedWithCountDepthAndPositions) {
  // A cloth of 5 x 5 particles, 0.25 m apart, at height 0: one particle is 0.3 m inside, its four neighbours 0.3 - 0.25 m.
  const auto lines = refusal(cloth(5, 0.0), {}, {ball(0.3, Vector3::Zero())});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("bodies.cloth = 5 particles inside, "));
  EXPECT_THAT(lines[0],
              AllOf(HasSubstr("triangles across: intersects obstacle \"ball\" at the start, up to 0.3 m deep: particle 7 at"),
                    HasSubstr("particle 11 at [-0.25, 0, 0], particle 12 at [0, 0, 0] and 2 more"), HasSubstr("move one of them")));
}

// A wall is 0.2 m thick and ends at x = 0. The pin holds particle 0 nearer to its other side.
TEST(Start, PinInsideAnObstacleHasItsOwnRemedy) {
  const auto rope = [](double first, const std::vector<Index>& pinned) {
    NetworkBuilder builder;
    BodyShape shape = make_rope({.points = {Vector3(first, 0, 0), Vector3(1, 0, 0)}, .particles = 21, .length = {}}, {});
    set_total_mass(shape, 1.0);
    builder.add_body("rope", shape, {}, {});
    builder.pin(pinned);
    return builder.build();
  };
  Obstacle wall{.name = "wall", .geometry = BoxGeometry{Vector3(0.2, 4.0, 4.0)}};
  wall.rest_pose.translation() = Vector3(-0.1, 0.0, 0.0);
  for (const auto start : {ContactSettings::Start::refuse, ContactSettings::Start::push_out}) {
    const SimulatorSettings settings{.contact = {.start = start}};
    const auto lines = refusal(rope(-0.12, {0}), settings, {wall});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_THAT(lines[0], AllOf(HasSubstr("2 particles inside"), HasSubstr("a pin holds particle 0 at [-0.12, 0, 0] inside")));
    EXPECT_THAT(refusal(rope(0.01, {0}), settings, {wall}), IsEmpty()) << "the pin moved";
    EXPECT_THAT(refusal(rope(-0.12, {0, 1, 2}), settings, {wall}), IsEmpty()) << "all particles inside are pinned";
  }
}

TEST(Start, AnObstacleBetweenParticlesIsFound) {
  const auto lines = refusal(cloth(2, 0.0), {}, {ball(0.1, Vector3(0.1, 0.05, 0.2))});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], AllOf(HasSubstr("triangle across"), HasSubstr("triangle of particles ")));
}

TEST(Start, EveryPairOfBodyAndObstacleHasALine) {
  NetworkBuilder builder;
  for (const char* name : {"left", "right"}) {
    builder.begin_body(name);
    builder.add_particle(Vector3(name[0] == 'l' ? -0.1 : 0.1, -0.2, 0.0), 0.1);
  }
  const auto lines = refusal(builder.build(), {}, {ground(), ball(1.0, Vector3::Zero())});
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[0],
              AllOf(HasSubstr("bodies.left = 1 particle inside"), HasSubstr("\"ground\" at the start, up to 0.2 m deep")));
  EXPECT_THAT(lines[3], AllOf(HasSubstr("bodies.right"), HasSubstr("\"ball\"")));
}

TEST(Start, AParticleOnAnOpenSurfaceIntersectsIt) {
  const auto lines = refusal(one_particle({0.25, 0.0, 0.25}), {}, {sheet(1.0)});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("1 particle across: intersects obstacle \"sheet\" at the start: particle 0 at [0.25, 0, 0.25]"));
  EXPECT_TRUE(refusal(one_particle({0.25, 1e-6, 0.25}), {}, {sheet(1.0)}).empty());
}

/// Two bodies: a rope of two particles (4 and 5) passes through a triangle of a patch (0 to 3).
SpringNetwork needle_and_patch(const BodyContact& contact, const std::vector<Index>& pinned = {}) {
  NetworkBuilder builder;
  BodyShape patch = make_cloth({.size = {1.0, 1.0}, .resolution = {2, 2}}, {});
  set_total_mass(patch, 1.0);
  BodyShape needle = make_rope({.points = {Vector3(0.1, 0.2, -1.0), Vector3(0.1, 0.2, 1.0)}, .particles = 2, .length = {}}, {});
  set_total_mass(needle, 1.0);
  builder.add_body("patch", patch, {}, contact);
  builder.add_body("needle", needle, {}, contact);
  if (!pinned.empty()) builder.pin(pinned);
  return builder.build();
}

TEST(Start, IntersectingBodiesThatCollideAreRefused) {
  const auto lines = refusal(needle_and_patch({}), {}, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], AllOf(HasSubstr("bodies.patch = 1 pair of elements: intersects body \"needle\" at the start: triangle of "),
                              HasSubstr(" and segment of particles 0, 1 at [0.1, 0.2, 0]"), HasSubstr("body_contact")));
  EXPECT_TRUE(refusal(needle_and_patch({.others = false}), {}, {}).empty());
  // Penalty contact acts on obstacles only.
  const ContactSettings penalty{.response = ContactSettings::Response::penalty, .stiffness = 1.0};
  EXPECT_TRUE(refusal(needle_and_patch({}), {.contact = penalty}, {}).empty());
}

TEST(Start, AnObstacleCountsAtTheStartOfItsMotion) {
  Obstacle passing = ball(0.5, Vector3(5.0, 0.0, 0.0));
  passing.motion.keyframes = {{0.0, Vector3(-5.0, 0.0, 0.0)}, {1.0, Vector3::Zero()}};
  EXPECT_EQ(refusal(one_particle({0.0, 0.1, 0.0}), {}, {passing}).size(), 1U);
  EXPECT_TRUE(refusal(one_particle({5.0, 0.1, 0.0}), {}, {passing}).empty());
}

SimulatorSettings pushing_out(const IntegratorSettings& integrator = VerletSettings{}) {
  SimulatorSettings settings{.gravity = Vector3::Zero(), .integrator = integrator};
  settings.contact.start = ContactSettings::Start::push_out;
  return settings;
}

TEST(Start, APushedParticleEndsAtItsGapFromTheNearestSurface) {
  const ContactMaterial thick{.thickness = 0.01};
  const Simulator simulator(one_particle({0.1, 0.0, 0.0}, thick), pushing_out(), {ball(0.3, Vector3::Zero())});
  // Contact passes leave a thousandth of the gap.
  EXPECT_LT((simulator.positions().col(0) - Vector3(0.31, 0.0, 0.0)).norm(), 1e-5);
  EXPECT_THAT(simulator.warnings(), IsEmpty()) << "the settings ask for it";
  ASSERT_EQ(simulator.notes().size(), 1U);
  EXPECT_EQ(simulator.notes()[0],
            "body \"ball\": intersected an obstacle or a body at the start and moved out: 1 particle by 0.21 m");
}

TEST(Start, PushingOutKeepsVelocities) {
  const Vector3 velocity(1.0, 2.0, -0.5);
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(one_particle({0.1, 0.0, 0.0}, {}, velocity), pushing_out(integrator), {ball(0.3, Vector3::Zero())});
    EXPECT_EQ(simulator.state().v.col(0), velocity);
    const Vector3 start = simulator.positions().col(0);
    const StepReport report = simulator.step();
    EXPECT_EQ(report.truncated, 0);
    // One step of a free particle: four roundings of coordinates below 1.
    EXPECT_LT((simulator.positions().col(0) - start - simulator.settings().step * velocity).norm(), 1e-15);
    EXPECT_LT((simulator.state().v.col(0) - velocity).norm(), 1e-12);
  }
}

TEST(Start, FreeParticlesAreNotPushed) {
  SimulatorSettings settings = pushing_out();
  settings.step = 1.0e-4;
  const SpringNetwork network = cloth(5, 0.01, {.thickness = 0.5});
  const Simulator simulator(network, settings, {ground()});
  EXPECT_EQ(simulator.positions(), network.positions);
}

TEST(Start, AParticleDeepInItsGapCausesAWarning) {
  const auto warnings = [](double height) {
    return Simulator(one_particle({0.0, height, 0.0}, {.thickness = 0.5}), {.step = 1e-3}, {ground({.thickness = 0.1})}).warnings();
  };
  EXPECT_THAT(warnings(0.29), ElementsAre(HasSubstr("starts 0.29 m from an obstacle, deep within the thickness of 0.6 m")));
  EXPECT_THAT(warnings(0.31), IsEmpty());
}

TEST(Start, BodiesDeepInTheSameGapAreToldOnceWithTheNearest) {
  NetworkBuilder builder;
  for (const auto& [name, height] : {std::pair{"a", 0.2}, {"b", 0.1}, {"c", 0.15}}) {
    builder.begin_body(name, {.thickness = 0.5});
    builder.add_particle({0.0, height, 0.0}, 0.1);
  }
  EXPECT_THAT(Simulator(builder.build(), {.step = 1e-3}, {ground()}).warnings(),
              ElementsAre(HasSubstr("bodies \"a\", \"b\" and 1 more: starts 0.1 m from an obstacle")));
}

TEST(Start, PenaltyContactPushesOutToo) {
  SimulatorSettings settings = pushing_out();
  settings.contact.response = ContactSettings::Response::penalty;
  settings.contact.stiffness = 10.0;
  const Simulator simulator(one_particle({0.0, -0.1, 0.0}), settings, {ground()});
  EXPECT_GT(simulator.positions()(1, 0), 0.0);
  EXPECT_LT(simulator.positions()(1, 0), 1e-8);
}

/// The particles that push_out moved.
std::vector<Index> moved(const SpringNetwork& network) {
  const Simulator simulator(network, pushing_out(), {});
  std::vector<Index> particles;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (simulator.positions().col(i) != network.positions.col(i)) particles.push_back(i);
  }
  return particles;
}

// A partly pinned body stays in place too: moving it would stretch it.
TEST(Start, TheLaterOfIntersectingBodiesIsPushedOutUnlessItIsPinned) {
  EXPECT_THAT(moved(needle_and_patch({})), AllOf(IsSubsetOf({4, 5}), SizeIs(Ge(1))));
  EXPECT_THAT(moved(needle_and_patch({}, {0, 1, 2, 3})), AllOf(IsSubsetOf({4, 5}), SizeIs(Ge(1))));
  EXPECT_THAT(moved(needle_and_patch({}, {5})), AllOf(IsSubsetOf({0, 1, 2, 3}), SizeIs(Ge(1))));
}

TEST(Start, PinnedBodiesThatIntersectAreRefused) {
  const auto lines = refusal(needle_and_patch({}, {0, 1, 2, 3, 4, 5}), pushing_out(), {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0],
              AllOf(HasSubstr("intersects body \"needle\""), HasSubstr("found no free position"), HasSubstr("body_contact")));
}

/// Two ropes "first" and "second" of five particles between two points each.
SpringNetwork two_ropes(const std::array<Vector3, 4>& ends, const std::vector<Index>& pinned = {}) {
  NetworkBuilder builder;
  for (std::size_t k = 0; k < 2; ++k) {
    BodyShape rope = make_rope({.points = {ends[2 * k], ends[2 * k + 1]}, .particles = 5, .length = {}}, {});
    set_total_mass(rope, 1.0);
    builder.add_body(k == 0 ? "first" : "second", rope, {.thickness = 0.01}, {});
  }
  if (!pinned.empty()) builder.pin(pinned);
  return builder.build();
}

TEST(Start, RopesWithACommonPointAreRefusedOrPushedApart) {
  const Vector3 left(-1.0, 0.0, 0.0);
  const Vector3 right(1.0, 0.0, 0.0);
  const Vector3 front(0.0, 0.0, 1.0);
  const Vector3 back(0.0, 0.0, -1.0);
  struct Case {
    std::array<Vector3, 4> ends;
    int pairs;
  };
  // Of equal ropes, each of the four segments has points in common with its counterpart and that one's neighbours. Of ropes that
  // cross in their middle particles, two segments of each have that point in common.
  for (const auto& [ends, pairs] :
       {Case{{left, right, left, right}, 10}, Case{{left, right, right, left}, 10},
        Case{{left, right, left + 0.25 * right, 3.0 * right}, 0}, Case{{left, right, front, back}, 4}}) {
    const SpringNetwork network = two_ropes(ends);
    const auto lines = refusal(network, {}, {});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_THAT(lines[0], HasSubstr("intersects body \"second\" at the start: segment of particles"));
    if (pairs > 0) {
      EXPECT_THAT(lines[0], HasSubstr("bodies.first = " + std::to_string(pairs) + " pairs of elements"));
    }
    const std::vector<Index> particles = moved(network);
    EXPECT_THAT(particles, AllOf(IsSubsetOf({5, 6, 7, 8, 9}), SizeIs(Ge(1))));
  }
  EXPECT_THAT(refusal(two_ropes({left, right, left + 1e-9 * front, right + 1e-9 * front}), {}, {}), IsEmpty());
}

TEST(Start, RopesMayHangFromOneHook) {
  const auto hung = [](const Vector3& second_end) {
    return two_ropes({Vector3::Zero(), Vector3::UnitX(), Vector3::Zero(), second_end}, {0, 5});
  };
  EXPECT_THAT(refusal(hung(-Vector3::UnitX()), {}, {}), IsEmpty());
  // Beyond the segments at the hook, equal ropes coincide.
  EXPECT_THAT(refusal(hung(Vector3::UnitX()), {}, {}), ElementsAre(HasSubstr("bodies.first = 9 pairs of elements")));
}

TEST(Start, EqualClothsAreRefusedOrPushedApart) {
  NetworkBuilder builder;
  for (const char* name : {"first", "second"}) {
    BodyShape sheet = make_cloth({.size = {1.0, 1.0}, .resolution = {4, 4}}, {});
    set_total_mass(sheet, 1.0);
    builder.add_body(name, sheet, {.thickness = 0.01}, {});
  }
  const SpringNetwork network = builder.build();
  EXPECT_THAT(refusal(network, {}, {}), ElementsAre(HasSubstr("intersects body \"second\"")));
  EXPECT_THAT(moved(network), AllOf(SizeIs(Ge(1)), IsSubsetOf({16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31})));
}

// A horizontal cloth through the middle of a ball as wide as half of it: push_out lifts it, and presses it back onto the ball.
TEST(Start, PushingOutWarnsOfABodyThatItStretches) {
  const auto warnings = [](double height) {
    SimulatorSettings settings = pushing_out();
    settings.step = 1.0e-4;
    return Simulator(cloth(21, height), settings, {ball(0.25, Vector3::Zero())}).warnings();
  };
  EXPECT_THAT(warnings(0.0),
              Contains(AllOf(HasSubstr("body \"cloth\": \"push_out\" moved it off obstacle \"ball\" and made an edge"),
                             HasSubstr(" % longer"), HasSubstr("Start it elsewhere"))));
  EXPECT_THAT(warnings(0.249), IsEmpty());
}

TEST(Start, BodiesThatDoNotCollideAreNotPushedApart) { EXPECT_THAT(moved(needle_and_patch({.others = false})), IsEmpty()); }

}  // namespace
}  // namespace sprung
