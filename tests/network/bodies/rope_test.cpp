#include "network/bodies/corners.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <limits>

namespace sprung {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const RopeShape kStraight{{Vector3(1, 2, 3), Vector3(4, 2, 3)}, 7, std::nullopt};

TEST(Rope, StructuralSpringsJoinNeighboursAndBendSpringsSkipOne) {
  const BodyShape rope = make_rope(kStraight, every_kind(stiff(10)));
  EXPECT_THAT(pairs(rope, SpringKind::structural),
              ElementsAre(Pair{0, 1}, Pair{1, 2}, Pair{2, 3}, Pair{3, 4}, Pair{4, 5}, Pair{5, 6}));
  EXPECT_THAT(pairs(rope, SpringKind::bend), ElementsAre(Pair{0, 2}, Pair{1, 3}, Pair{2, 4}, Pair{3, 5}, Pair{4, 6}));
  EXPECT_EQ(count(rope, SpringKind::shear), 0);
}

TEST(Rope, StartsAndEndsAtItsPointsWithEqualDistances) {
  const BodyShape rope = make_rope(kStraight, {});
  EXPECT_EQ(rope.positions.front(), Vector3(1, 2, 3));
  EXPECT_EQ(rope.positions.back(), Vector3(4, 2, 3));
  // Positions of size 4 carry rounding errors of some 4 * 2^-53.
  for (Index i = 0; i < 7; ++i) EXPECT_NEAR((rope.positions[i] - Vector3(1 + 0.5 * i, 2, 3)).norm(), 0.0, 1e-14);
  EXPECT_DOUBLE_EQ(rope.measure, 3.0);
}

TEST(Rope, ResamplesAPolylineAtEqualArcLength) {
  // 3 m along x, then 1 m along y: five particles lie 1 m apart along it.
  const RopeShape bent{{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(3, 0, 0), Vector3(3, 1, 0)}, 5, std::nullopt};
  const BodyShape rope = make_rope(bent, {stiff(1), std::nullopt, stiff(1)});
  const Vector3 expected[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}};
  for (Index i = 0; i < 5; ++i) EXPECT_NEAR((rope.positions[i] - expected[i]).norm(), 0.0, 1e-14);
  for (Index s = 0; s < rope.springs.count(); ++s) {
    EXPECT_DOUBLE_EQ(rope.springs.rest_length[s], rope.springs.second[s] - rope.springs.first[s]) << "spring " << s;
  }
}

TEST(Rope, WithoutACountHasAParticleAtEachPoint) {
  const RopeShape bent{{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(2, 1, 0)}, std::nullopt, std::nullopt};
  const BodyShape rope = make_rope(bent, {stiff(1), std::nullopt, std::nullopt});
  EXPECT_EQ(rope.positions, bent.points);
  EXPECT_THAT(rope.springs.rest_length, ElementsAre(2.0, 1.0));
}

TEST(Rope, LengthSetsRestLengthsButNotPositions) {
  // Springs of rest length 2 m between particles 3 m apart.
  const RopeShape stretched{{Vector3(0, 0, 0), Vector3(12, 0, 0)}, 5, 8.0};
  const BodyShape rope = make_rope(stretched, {stiff(1), std::nullopt, std::nullopt});
  EXPECT_THAT(rope.springs.rest_length, ElementsAre(2.0, 2.0, 2.0, 2.0));
  EXPECT_EQ(rope.positions[3], Vector3(9, 0, 0));
  EXPECT_EQ(rope.measure, 8.0);

  const RopeShape by_points{{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(2, 1, 0)}, std::nullopt, 6.0};
  EXPECT_THAT(make_rope(by_points, {stiff(1), std::nullopt, std::nullopt}).springs.rest_length, ElementsAre(4.0, 2.0));
}

TEST(Rope, ModulusPullsAlikeAtAnyResolution) {
  for (const Index particles : {2, 3, 10, 101}) {
    const RopeShape shape{{Vector3(0, 0, 0), Vector3(0, 2, 0)}, particles, std::nullopt};
    const BodyShape rope = make_rope(shape, {modular(300), std::nullopt, std::nullopt});
    // EA strain = 300 N * 0.01; the strain of a spring, a difference of numbers near 1 / particles, keeps 1e-14 / 0.01.
    EXPECT_NEAR(stretching_force(rope, 1, 0.99, 0.01), 3.0, 1e-10) << particles << " particles";
  }
}

TEST(Rope, HasSegmentsAndDragByLength) {
  const BodyShape rope = make_rope(kStraight, {});
  EXPECT_EQ(rope.surface.segments.cols(), 6);
  EXPECT_EQ(rope.surface.segments.col(5), (Eigen::Matrix<Index, 2, 1>(5, 6)));
  EXPECT_EQ(rope.surface.triangles.cols(), 0);
  EXPECT_EQ(rope.drag_areas, rope.measures);
}

TEST(Rope, MayPassThroughAPointTwice) {
  const RopeShape doubled{{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 0, 0), Vector3(2, 0, 0)}, std::nullopt, std::nullopt};
  EXPECT_THAT(make_rope(doubled, {stiff(1), std::nullopt, std::nullopt}).springs.rest_length, ElementsAre(1.0, 0.0, 1.0));
  EXPECT_THAT(problem_keys([&] { return make_rope(doubled, {modular(1), std::nullopt, std::nullopt}); }), ElementsAre("points[2]"));
}

TEST(Rope, RejectsInvalidRopes) {
  const auto keys = [](const RopeShape& rope) { return problem_keys([&] { return make_rope(rope, {}); }); };
  const Vector3 origin = Vector3::Zero();
  EXPECT_THAT(keys({}), ElementsAre("points"));
  EXPECT_THAT(keys({{origin}, std::nullopt, std::nullopt}), ElementsAre("points"));
  EXPECT_THAT(keys({{origin, origin}, 5, std::nullopt}), ElementsAre("points (length of the polyline)"));
  EXPECT_THAT(keys({{origin, Vector3(kNan, 0, 0)}, 5, std::nullopt}), ElementsAre("points[1]"));
  EXPECT_THAT(keys({{origin, Vector3::Ones()}, 1, std::nullopt}), ElementsAre("particles"));
  EXPECT_THAT(keys({{origin, Vector3::Ones()}, -4, std::nullopt}), ElementsAre("particles"));
  EXPECT_THAT(keys({{origin, Vector3::Ones()}, kMaxBodyParticles + 1, std::nullopt}), ElementsAre("particles"));
  for (const double length : {0.0, -1.0, kNan}) {
    EXPECT_THAT(keys({{origin, Vector3::Ones()}, 5, length}), ElementsAre("length"));
  }
}

TEST(Rope, ReportsEveryProblemInOneGo) {
  const RopeShape rope{{Vector3(0, kNan, 0)}, 0, -1.0};
  const SpringMaterials materials{SpringMaterial{-1.0, SpringMaterial::Measure::stiffness, kNan}, std::nullopt, modular(-2.0)};
  EXPECT_THAT(problem_keys([&] { return make_rope(rope, materials); }),
              UnorderedElementsAre("points[0]", "points", "particles", "length", "springs.structural.stiffness",
                                   "springs.structural.damping", "springs.bend.modulus"));
}

TEST(Rope, ParticlesHaveEqualMasses) {
  BodyShape rope = make_rope(kStraight, {});
  set_total_mass(rope, 3.5);
  EXPECT_EQ(rope.masses, std::vector<double>(7, 0.5));
  for (const double mass : {0.0, -1.0, kNan}) {
    EXPECT_THAT(problem_keys([&] {
                  set_total_mass(rope, mass);
                  return 0;
                }),
                ElementsAre("mass"));
  }
}

TEST(Rope, PlacingRotatesThenMovesAndAddsAVelocity) {
  BodyShape rope = make_rope(kStraight, {});
  rope.velocities[0] = Vector3(1, 0, 0);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x to y, y to -x
  pose.translation() << 10, 0, 0;
  place(rope, pose, Vector3(0, 0, 5));
  EXPECT_EQ(rope.positions[0], Vector3(8, 1, 3));
  EXPECT_EQ(rope.velocities[0], Vector3(0, 1, 5));
  EXPECT_EQ(rope.velocities[1], Vector3(0, 0, 5));
}

TEST(Rope, CornersAreItsEnds) {
  EXPECT_THAT(corner_names(kStraight), ElementsAre("from", "to"));
  EXPECT_EQ(corner_particle(kStraight, "from"), 0);
  EXPECT_EQ(corner_particle(kStraight, "to"), 6);
  EXPECT_EQ(corner_particle(RopeShape{{Vector3::Zero(), Vector3::Ones()}, std::nullopt, std::nullopt}, "to"), 1);
  EXPECT_EQ(corner_particle(kStraight, "min"), std::nullopt);
}

}  // namespace
}  // namespace sprung
