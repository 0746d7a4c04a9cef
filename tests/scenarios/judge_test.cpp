// Tests the judge itself on hand-made cases.
#include "scenarios/judge.h"

#include "collision/sample_meshes.h"
#include "network/network_builder.h"
#include "scenarios/primitive_judge.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

namespace sprung::testing {
namespace {

const std::vector<JudgedElement> kTriangle = {{{0, 1, 2}, 3}};
const std::vector<JudgedElement> kSegment = {{{0, 1, kNone}, 2}};

Points points(std::initializer_list<Vector3> list) {
  Points result(3, static_cast<Index>(list.size()));
  Index i = 0;
  for (const Vector3& p : list) result.col(i++) = p;
  return result;
}

/// The unit cube [0, 1]^3.
TriangleMesh cube() {
  TriangleMesh mesh{Points(3, 8), Triangles(3, 12)};
  for (Index i = 0; i < 8; ++i) mesh.vertices.col(i) = Vector3(i % 2, i / 2 % 2, i / 4);
  mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  return mesh;
}

TEST(JudgeOfAMesh, CountsParticlesInsideAndOnTheSurface) {
  const auto judge = judge_of(cube(), true);
  EXPECT_GT(signed_volume(cube()), 0.0);
  const double tiny = 0x1p-60;
  EXPECT_EQ(judge->count_inside(points({{0.5, 0.5, 0.5}, {tiny, 0.25, 0.25}, {0.0, 0.25, 0.25}, {1.0, 1.0, 1.0}})), 4);
  EXPECT_EQ(judge->count_inside(points({{-tiny, 0.25, 0.25}, {0.5, 0.5, 1.0 + 0x1p-52}, {0.5, -3.0, 0.5}})), 0);
}

TEST(JudgeOfAMesh, AgreesWithTheWindingNumberOnNeedles) {
  const TriangleMesh needles = test::needles(24);
  const auto judge = judge_of(needles, true);
  test::Random random(1);
  Index inside = 0;
  for (int n = 0; n < 400; ++n) {
    const Vector3 p = test::near_surface(needles, random, 0.02);
    const bool expected = test::winding_number(needles, p) > 0.5;
    inside += expected ? 1 : 0;
    ASSERT_EQ(judge->count_inside(p), expected ? 1 : 0) << "point " << n;
  }
  EXPECT_GT(inside, 50);
}

TEST(JudgeOfAMesh, AnOpenMeshHasNoInside) {
  const TriangleMesh sheet = test::flat_sheet(2);
  EXPECT_EQ(judge_of(sheet, false)->count_inside(points({{0.3, 0.0, 0.3}, {0.3, -1.0, 0.3}})), 0);
}

TEST(JudgeOfAMesh, RefusesAClosedMeshThatIsNotOriented) {
  TriangleMesh mesh = cube();
  std::swap(mesh.triangles(0, 0), mesh.triangles(1, 0));
  EXPECT_THROW(static_cast<void>(judge_of(mesh, true)), std::invalid_argument);
}

// One triangle in the plane y = 0, with its right angle at the origin.
class CrossingsOfATriangle : public ::testing::Test {
 protected:
  CrossingsOfATriangle() {
    mesh_.vertices = points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    mesh_.triangles = Triangles(3, 1);
    mesh_.triangles << 0, 1, 2;
    judge_ = judge_of(mesh_, false);
  }
  [[nodiscard]] Index crossings(const std::vector<JudgedElement>& elements, std::initializer_list<Vector3> list) const {
    return judge_->count_crossings(elements, points(list));
  }

  TriangleMesh mesh_;
  std::unique_ptr<const ObstacleJudge> judge_;
};

TEST_F(CrossingsOfATriangle, EdgeThroughItsFace) {
  EXPECT_EQ(crossings(kSegment, {{0.25, -1, 0.25}, {0.25, 1, 0.25}}), 1);
  EXPECT_EQ(crossings(kTriangle, {{0.25, -1, 0.25}, {0.25, 1, 0.25}, {0.25, 1, 9}}), 1);
}

TEST_F(CrossingsOfATriangle, ItsTipThroughTheOthersFace) {
  // No edge of the element crosses the triangle of the mesh. Only edges of that triangle cross the element's face.
  EXPECT_EQ(crossings(kTriangle, {{0.9, -9, -9}, {0.9, 9, -9}, {0.9, 0, 9}}), 1);
}

TEST_F(CrossingsOfATriangle, EdgeAcrossItsEdge) {
  EXPECT_EQ(crossings(kSegment, {{0.5, -1, -0.5}, {0.5, 1, 0.5}}), 1) << "through the middle of a side";
}

TEST_F(CrossingsOfATriangle, TouchingCountsAsCrossing) {
  EXPECT_EQ(crossings(kSegment, {{0.25, 0, 0.25}, {0.25, 1, 0.25}}), 1) << "an end on the face";
  EXPECT_EQ(crossings(kSegment, {{-1, 0, 0}, {0, 0, 0}}), 1) << "end on corner";
  EXPECT_EQ(crossings(kTriangle, {{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}}), 1) << "corner on corner";
}

TEST_F(CrossingsOfATriangle, CoplanarOverlapCountsAndCoplanarGapDoesNot) {
  EXPECT_EQ(crossings(kTriangle, {{0.1, 0, 0.1}, {0.1, 0, 0.2}, {0.2, 0, 0.1}}), 1) << "within it";
  EXPECT_EQ(crossings(kTriangle, {{1, 0, 1}, {0.75, 0, 1}, {1, 0, 0.75}}), 0) << "boxes overlap, triangles do not";
}

TEST_F(CrossingsOfATriangle, TheSmallestGapIsNoCrossing) {
  const double tiny = 0x1p-1000;
  EXPECT_EQ(crossings(kTriangle, {{0.1, tiny, 0.1}, {0.1, tiny, 0.2}, {0.2, tiny, 0.1}}), 0);
  EXPECT_EQ(crossings(kTriangle, {{0.1, tiny, 0.1}, {0.1, -tiny, 0.2}, {0.2, tiny, 0.1}}), 1);
}

TEST_F(CrossingsOfATriangle, DistanceIsThatOfTheNearestPoint) {
  EXPECT_DOUBLE_EQ(judge_->distance({0.25, -2.0, 0.25}), 2.0);
  EXPECT_DOUBLE_EQ(judge_->distance({1.0, 0.0, 1.0}), std::sqrt(0.5));
}

TEST(SelfCrossings, IntersectingElementsWithoutCommonParticlesAreCounted) {
  const std::vector<JudgedElement> two = {{{0, 1, 2}, 3}, {{3, 4, 5}, 3}};
  const Points crossing = points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.25, -1, 0.25}, {0.25, 1, 0.25}, {0.25, 1, 9}});
  EXPECT_EQ(count_self_crossings(two, crossing), 1);
  Points apart = crossing;
  apart.rightCols(3).array() += 10.0;
  EXPECT_EQ(count_self_crossings(two, apart), 0);
  EXPECT_EQ(count_self_crossings({{{0, 1, 2}, 3}, {{3, 4, kNone}, 2}}, crossing), 1) << "a segment through a triangle";
}

TEST(SelfCrossings, TheSharedCornerAloneIsNoCrossing) {
  const std::vector<JudgedElement> fan = {{{0, 1, 2}, 3}, {{3, 0, 4}, 3}};
  const Points x = points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.25, 0.5, 0.25}, {-1, 0, -1}});
  EXPECT_EQ(count_self_crossings(fan, x), 0);
  Points through = x;
  through.col(3) << 0.75, -0.5, 0.75;
  through.col(4) << -1.0, 0.1, -1.0;
  EXPECT_EQ(count_self_crossings(fan, through), 0) << "the side opposite the shared corner passes beside the face";
  through.col(4) << 0.0, 0.5, 0.0;
  EXPECT_EQ(count_self_crossings(fan, through), 1) << "the side opposite the shared corner goes through the face";
  EXPECT_EQ(count_self_crossings({fan[1], fan[0]}, through), 1);
}

TEST(SelfCrossings, CoplanarFansIntersectWhenTheyOverlap) {
  const std::vector<JudgedElement> fan = {{{0, 1, 2}, 3}, {{0, 3, 4}, 3}};
  EXPECT_EQ(count_self_crossings(fan, points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.1, 0, 0.2}, {0.2, 0, 0.1}})), 1);
  EXPECT_EQ(count_self_crossings(fan, points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {4, 0, 8}, {8, 0, 4}})), 1);
  EXPECT_EQ(count_self_crossings(fan, points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.1, 0, 0.2}, {-0.2, 0, 0.1}})), 0);
}

TEST(SelfCrossings, TrianglesIntersectBeyondASharedEdgeOnlyWhenFoldedFlat) {
  const std::vector<JudgedElement> hinge = {{{0, 1, 2}, 3}, {{1, 0, 3}, 3}};
  EXPECT_EQ(count_self_crossings(hinge, points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {-1, 0, 0.5}})), 0) << "flat";
  EXPECT_EQ(count_self_crossings(hinge, points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {1, 0x1p-60, 0.5}})), 0) << "nearly folded";
  EXPECT_EQ(count_self_crossings(hinge, points({{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0.3, 0, 0.5}})), 1) << "folded";
}

TEST(SelfCrossings, ARopeFoldedBackOntoItselfIntersectsItself) {
  const std::vector<JudgedElement> rope = {{{0, 1, kNone}, 2}, {{1, 2, kNone}, 2}};
  EXPECT_EQ(count_self_crossings(rope, points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})), 0);
  EXPECT_EQ(count_self_crossings(rope, points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})), 0);
  EXPECT_EQ(count_self_crossings(rope, points({{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}})), 1);
}

TEST(JudgedElements, AreInTheNetworksNumbering) {
  NetworkBuilder builder;
  BodyShape rope = make_rope({.points = {{0, 0, 0}, {1, 0, 0}}, .particles = {}, .length = {}}, {});
  set_total_mass(rope, 1.0);
  BodyShape cloth = make_cloth({}, {});
  set_total_mass(cloth, 1.0);
  builder.add_body("rope", rope);
  builder.add_body("cloth", cloth);
  const std::vector<JudgedElement> elements = judged_elements(builder.build());
  ASSERT_EQ(elements.size(), 3u);
  EXPECT_EQ(elements[0].corners, 2);
  EXPECT_EQ(elements[0].particles, (std::array<Index, 3>{0, 1, kNone}));
  for (const std::size_t t : {1u, 2u}) {
    EXPECT_EQ(elements[t].corners, 3);
    for (const Index i : elements[t].particles) EXPECT_TRUE(i >= 2 && i < 6) << i;
  }
}

struct PrimitiveCase {
  const char* name;
  ObstacleGeometry geometry;
  Vector3 inside;     ///< near the surface
  Vector3 on;         ///< on the surface, where it is convex in every direction
  Vector3 outward;    ///< normal there
  Vector3 direction;  ///< in the tangent plane
};

class JudgeOfAPrimitive : public ::testing::TestWithParam<PrimitiveCase> {};

TEST_P(JudgeOfAPrimitive, MeasureIsZeroOnTheSurfaceNegativeInsideAndPositiveOutside) {
  const PrimitiveCase& c = GetParam();
  EXPECT_NEAR(convex_measure(c.geometry, c.on).value, 0.0, 1e-15);
  EXPECT_LT(convex_measure(c.geometry, c.inside).value, 0.0);
  EXPECT_GT(convex_measure(c.geometry, c.on + 1e-9 * c.outward).value, 0.0);
  EXPECT_LE(convex_measure(c.geometry, c.on + 0.5 * c.outward).value, 0.5 + 1e-15) << "at most the distance";
}

TEST_P(JudgeOfAPrimitive, TangentPlanesAreNowhereAboveTheMeasure) {
  const ObstacleGeometry& geometry = GetParam().geometry;
  test::Random random(1);
  const Box3 around(Vector3::Constant(-3.0), Vector3::Constant(3.0));
  for (int n = 0; n < 1000; ++n) {
    const Vector3 p = random.in_box(around);
    const Vector3 q = random.in_box(around);
    const ConvexMeasure at_p = convex_measure(geometry, p);
    ASSERT_GE(convex_measure(geometry, q).value, at_p.value + at_p.slope.dot(q - p) - 1e-14);
    ASSERT_LE(at_p.slope.norm(), 1.0 + 1e-15);
  }
}

TEST_P(JudgeOfAPrimitive, AnElementWithOnlyItsMiddleInsideIsFound) {
  const PrimitiveCase& c = GetParam();
  const Vector3 other = c.outward.cross(c.direction);
  for (const double depth : {1e-9, -1e-9}) {
    const Vector3 middle = c.on - depth * c.outward;
    const Points x =
        points({middle + 3.0 * c.direction, middle - 3.0 * c.direction + 2.0 * other, middle - 3.0 * c.direction - 2.0 * other});
    const auto judge = judge_of(c.geometry);
    const Index expected = depth > 0.0 ? 1 : 0;
    EXPECT_EQ(judge->count_crossings(kTriangle, x), expected) << "depth " << depth;
    EXPECT_EQ(judge->count_crossings(kSegment, points({middle - 3.0 * c.direction, middle + 2.0 * c.direction})), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, JudgeOfAPrimitive,
    ::testing::Values(
        PrimitiveCase{"sphere", SphereGeometry{.radius = 0.5}, {0, 0.4, 0}, {0.3, 0.4, 0}, {0.6, 0.8, 0}, {0, 0, 1}},
        PrimitiveCase{"box",
                      BoxGeometry{.size = {1, 2, 3}},
                      {0.4, 0, 0},
                      {0.5, 1, 1.5},
                      Vector3(1, 1, 1).normalized(),
                      Vector3(1, -1, 0).normalized()},
        PrimitiveCase{
            "capsule", CapsuleGeometry{.radius = 0.5, .length = 1}, {0.4, 0.5, 0}, {0.3, 0.9, 0}, {0.6, 0.8, 0}, {0, 0, 1}},
        PrimitiveCase{"cylinder",
                      CylinderGeometry{.radius = 0.5, .height = 1},
                      {0.4, 0.4, 0},
                      {0.5, 0.5, 0},
                      Vector3(1, 1, 0).normalized(),
                      {0, 0, 1}},
        PrimitiveCase{"cone", ConeGeometry{.radius = 1, .height = 1}, {0, 0.4, 0}, {0, 0.5, 0}, {0, 1, 0}, {0, 0, 1}},
        PrimitiveCase{"ellipsoid", EllipsoidGeometry{.radii = {1, 2, 3}}, {0, 1.9, 0}, {0, 2, 0}, {0, 1, 0}, {1, 0, 0}},
        PrimitiveCase{
            "half_space", HalfSpaceGeometry{.normal = {0, 1, 0}, .offset = 2}, {7, 1.9, 0}, {7, 2, 0}, {0, 1, 0}, {1, 0, 0}}),
    [](const auto& shape) { return shape.param.name; });

}  // namespace
}  // namespace sprung::testing
