#include "base/error.h"
#include "collision/sample_meshes.h"
#include "collision/shapes/mesh_shape.h"
#include "collision/shapes/obstacle_shape.h"
#include "collision/single_particles.h"

#include <gmock/gmock.h>

#include <cmath>

namespace sprung {
namespace {

using test::Random;

/// A sequence with 10 frames per second. Its vertices are `deform(position, frame)`.
template <class Deform>
std::shared_ptr<const MeshSequence> sequence_of(const TriangleMesh& mesh, int frames, const Deform& deform) {
  MeshSequence sequence{.triangles = mesh.triangles, .frames = {}, .frame_rate = 10.0};
  for (int k = 0; k < frames; ++k) {
    Points& positions = sequence.frames.emplace_back(mesh.vertices);
    for (Index i = 0; i < positions.cols(); ++i) positions.col(i) = deform(Vector3(mesh.vertices.col(i)), k);
  }
  return std::make_shared<const MeshSequence>(sequence);
}

/// A torus that scales, bends and translates.
std::shared_ptr<const MeshSequence> deforming_torus() {
  return sequence_of(test::torus(1.0, 0.3, 40, 20), 6, [](const Vector3& x, int k) {
    return Vector3((1.0 + 0.2 * std::sin(k)) * x + Vector3(0.3 * k, 0.4 * std::sin(2.0 * k) * x.x() * x.x(), 0.1 * x.y()));
  });
}

/// The mesh at a time [s], interpolated between two frames of a sequence with 10 frames per second.
TriangleMesh mesh_at(const MeshSequence& sequence, double time) {
  const double frame = std::clamp(10.0 * time, 0.0, static_cast<double>(sequence.frames.size() - 1));
  const auto a = static_cast<std::size_t>(frame);
  const std::size_t b = std::min(a + 1, sequence.frames.size() - 1);
  const double fraction = frame - static_cast<double>(a);
  return {(1.0 - fraction) * sequence.frames[a] + fraction * sequence.frames[b], sequence.triangles};
}

struct Interval {
  double begin;
  double end;
};

/// Between two frames, at frames, across one and several frames, before the first and after the last, and back in time.
constexpr Interval kIntervals[] = {{0.0, 0.0},   {0.0, 0.03}, {0.03, 0.06}, {0.06, 0.1}, {0.1, 0.13},  {0.17, 0.24},
                                   {0.05, 0.45}, {0.48, 0.6}, {0.6, 0.7},   {-1.0, 0.0}, {-1.0, 0.02}, {0.22, 0.28}};

TEST(SequenceShape, NearestPointIsThatOfTheMeshAtTheEndOfTheInterval) {
  const auto sequence = deforming_torus();
  const MeshShape all_times(SequenceGeometry{sequence, true});
  Random random(31);
  for (const auto& [begin, end] : kIntervals) {
    const auto shape = all_times.in_interval(begin, end);
    const TriangleMesh mesh = mesh_at(*sequence, end);
    const Box3 box = bounds(mesh.vertices);
    for (int i = 0; i < 40; ++i) {
      const Vector3 p = i % 2 == 0 ? random.in_box(box) : test::near_surface(mesh, random, 0.02);
      const double expected = test::brute_distance(mesh, p);
      const auto found = shape->nearest(p, 10.0);
      ASSERT_TRUE(found);
      // Coordinates of a few metres have rounding errors of 1e-15 m.
      ASSERT_NEAR(std::abs(found->distance), expected, 1e-13) << end;
      ASSERT_NEAR((p - found->point).norm(), expected, 1e-13);
      ASSERT_EQ(found->distance<0.0, test::winding_number(mesh, p)> 0.5) << end << ' ' << p.transpose();
      ASSERT_EQ(shape->contains(p), found->distance < 0.0);
    }
  }
}

TEST(SequenceShape, ADeformingMeshEqualsTheRigidMeshAtTheSameTime) {
  const auto sequence = deforming_torus();
  const MeshShape all_times(SequenceGeometry{sequence, true});
  const auto shape = all_times.in_interval(0.11, 0.3);
  const MeshShape rigid(
      MeshGeometry{std::make_shared<const TriangleMesh>(TriangleMesh{sequence->frames[3], sequence->triangles}), true});
  Random random(32);
  for (int i = 0; i < 500; ++i) {
    const Vector3 p = test::near_surface({sequence->frames[3], sequence->triangles}, random, 0.05);
    const Vector3 q = test::near_surface({sequence->frames[3], sequence->triangles}, random, 0.05);
    const auto found = shape->nearest(p, 1.0);
    const auto expected = rigid.nearest(p, 1.0);
    // The trees differ. Where two triangles share the closest point, either may be found.
    ASSERT_LT((found->point - expected->point).norm(), 1e-14);
    ASSERT_NEAR(found->distance, expected->distance, 1e-14);
    ASSERT_LT((found->normal - expected->normal).norm(), 1e-14 / std::abs(found->distance));
    const auto crossing = shape->first_crossing(p, q);
    const auto expected_crossing = rigid.first_crossing(p, q);
    ASSERT_EQ(crossing.has_value(), expected_crossing.has_value());
    if (!crossing) continue;
    ASSERT_EQ(crossing->fraction, expected_crossing->fraction);
    ASSERT_EQ(crossing->normal, expected_crossing->normal);
  }
}

TEST(SequenceShape, QueriesDoNotDependOnEarlierIntervals) {
  const auto sequence = deforming_torus();
  const MeshShape direct(SequenceGeometry{sequence, true});
  const MeshShape diverted(SequenceGeometry{sequence, true});
  Random random(33);
  for (const auto& [begin, end] : kIntervals) {
    (void)diverted.in_interval(random.between(-0.1, 0.6), random.between(-0.1, 0.6));
    const auto second = diverted.in_interval(begin, end);
    const auto first = direct.in_interval(begin, end);
    EXPECT_EQ(second->bounds().min(), first->bounds().min());
    for (int i = 0; i < 50; ++i) {
      const Vector3 p = random.in_box(first->bounds());
      EXPECT_EQ(second->nearest(p, 10.0)->point, first->nearest(p, 10.0)->point);
    }
  }
}

/// What a shape answers about these points.
std::vector<double> answers(const ObstacleShape& shape, const std::vector<Vector3>& points) {
  std::vector<double> all{shape.largest_displacement()};
  const auto append = [&](const Vector3& p) { all.insert(all.end(), p.begin(), p.end()); };
  append(shape.bounds().min());
  append(shape.bounds().max());
  for (const Vector3& p : points) {
    append(shape.nearest(p, 10.0)->point);
    append(shape.displacement(p));
    append(shape.moved_triangle(p)->after[0]);
    SafeRegion region;
    shape.find_region({.x = {p}, .count = 1}, {.reach = 0.2, .gap = 0.02, .clearance = 1e-9, .exact = 0.1}, region);
    append(region.point);
    append(region.box.max());
  }
  return all;
}

TEST(SequenceShape, OtherIntervalsDoNotChangeAShape) {
  const MeshShape sequence(SequenceGeometry{deforming_torus(), true});
  Random random(37);
  std::vector<Vector3> points;
  for (int i = 0; i < 50; ++i) points.push_back(random.in_box(sequence.bounds()));
  std::vector<std::shared_ptr<const ObstacleShape>> shapes;
  std::vector<std::vector<double>> answers_at_first;
  for (const auto& [begin, end] : kIntervals) {
    shapes.push_back(sequence.in_interval(begin, end));
    answers_at_first.push_back(answers(*shapes.back(), points));
  }
  for (std::size_t k = 0; k < shapes.size(); ++k) EXPECT_EQ(answers(*shapes[k], points), answers_at_first[k]) << k;
}

TEST(SequenceShape, BoundsContainTheTrianglesThroughoutTheInterval) {
  const auto sequence = deforming_torus();
  const MeshShape all_times(SequenceGeometry{sequence, true});
  for (const auto& [begin, end] : kIntervals) {
    const auto shape = all_times.in_interval(begin, end);
    const TriangleMesh before = mesh_at(*sequence, begin);
    const TriangleMesh after = mesh_at(*sequence, end);
    // The interpolation in this test, (1 - s) a + s b, has other rounding errors.
    const Box3 box(shape->bounds().min().array() - 1e-14, shape->bounds().max().array() + 1e-14);
    EXPECT_TRUE(box.contains(bounds(before.vertices)) && box.contains(bounds(after.vertices))) << begin << ' ' << end;
    for (Index t = 0; t < after.triangles.cols(); ++t) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT((static_cast<const MeshShape&>(*shape).tree().corners(t)[static_cast<std::size_t>(k)] -
                   after.vertices.col(after.triangles(k, t)))
                      .norm(),
                  1e-14);
      }
    }
  }
}

TEST(SequenceShape, DisplacementIsThatOfTheNearestSurfacePoint) {
  // The sheet rises by 0.1 m per frame, and x [m] becomes x (1 + 0.5 k) in frame k. The map is affine, so it is exact between
  // vertices.
  const auto sequence =
      sequence_of(test::flat_sheet(4), 3, [](const Vector3& x, int k) { return Vector3((1.0 + 0.5 * k) * x.x(), 0.1 * k, x.z()); });
  const MeshShape all_times(SequenceGeometry{sequence, false});
  const auto shape = all_times.in_interval(0.05, 0.1);
  EXPECT_DOUBLE_EQ(shape->largest_displacement(), std::hypot(0.25 * 2.0, 0.05));
  // At the end x is 1.5 times its initial value. From 0.05 to 0.1 s it grew by 0.25 of that value.
  EXPECT_LT((shape->displacement({1.8, 0.4, 0.3}, 0.05, 0.1) - Vector3(1.8 / 1.5 * 0.25, 0.05, 0.0)).norm(), 1e-15);
  EXPECT_LT((shape->displacement({1.8, -0.4, 0.3}, 0.1, 0.12) - Vector3(1.8 / 1.5 * 0.1, 0.02, 0.0)).norm(), 1e-15);
  // At the begin x was 1.25 times its initial value.
  EXPECT_LT((shape->displacement({1.8, 0.4, 0.3}) - Vector3(1.8 / 1.25 * 0.25, 0.05, 0.0)).norm(), 1e-15);
  EXPECT_EQ(all_times.in_interval(0.3, 0.4)->largest_displacement(), 0.0) << "the sequence rests after its last frame";
}

TEST(SequenceShape, ASequenceOfEqualFramesIsRigid) {
  const MeshShape shape(SequenceGeometry{sequence_of(test::flat_sheet(2), 3, [](const Vector3& x, int) { return x; }), false});
  EXPECT_FALSE(shape.deforms());
  EXPECT_EQ(shape.in_interval(0.1, 0.2), nullptr) << "it is the same at all times";
  EXPECT_EQ(shape.nearest({0.2, 0.3, 0.4}, 1.0)->distance, 0.3);
  EXPECT_EQ(shape.displacement({0.2, 0.3, 0.4}, 0.0, 0.2), Vector3::Zero());
}

TEST(SequenceShape, TemporarilyDegenerateFacesHaveUnitNormals) {
  // The squares in the middle row of the sheet collapse and open again. In frame 2 the whole sheet is a point.
  const auto sequence = sequence_of(test::flat_sheet(3), 3, [](const Vector3& x, int k) {
    return Vector3(k == 1 && x.x() > -0.5 && x.x() < 0.5 ? Vector3(0.0, 0.0, x.z()) : k == 2 ? Vector3(0.0, 0.0, 0.0) : x);
  });
  for (const bool closed : {false, true}) {
    const MeshShape all_times(SequenceGeometry{sequence, closed});
    Random random(34);
    for (const double end : {0.1, 0.2}) {
      const auto shape = all_times.in_interval(0.0, end);
      for (int i = 0; i < 200; ++i) {
        const Vector3 p(random.between(-1.0, 1.0), i % 3 == 0 ? 0.0 : random.between(-0.1, 0.1), random.between(-1.0, 1.0));
        const auto found = shape->nearest(i % 5 == 0 ? Vector3::Zero() : p, 10.0);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->normal.norm(), 1.0, 1e-12);
        EXPECT_TRUE(std::isfinite(found->distance));
      }
    }
  }
}

TEST(SequenceShape, ScalingByAPowerOfTwoScalesEveryBit) {
  const auto sequence = deforming_torus();
  MeshSequence larger = *sequence;
  for (Points& frame : larger.frames) frame *= 128.0;
  const MeshShape all_times(SequenceGeometry{sequence, true});
  const MeshShape large_all_times(SequenceGeometry{std::make_shared<const MeshSequence>(larger), true});
  Random random(35);
  for (const auto& [begin, end] : kIntervals) {
    const auto shape = all_times.in_interval(begin, end);
    const auto large = large_all_times.in_interval(begin, end);
    EXPECT_EQ(128.0 * shape->largest_displacement(), large->largest_displacement());
    for (int i = 0; i < 50; ++i) {
      const Vector3 p = random.in_box(shape->bounds());
      EXPECT_EQ(128.0 * shape->nearest(p, 10.0)->point, large->nearest(128.0 * p, 1280.0)->point);
      EXPECT_EQ(128.0 * shape->displacement(p, begin, end), large->displacement(128.0 * p, begin, end));
    }
  }
}

std::vector<std::string> rules_broken_by(const SequenceGeometry& geometry) {
  std::vector<std::string> rules;
  try {
    (void)make_shape(geometry);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) rules.push_back(problem.key + ": " + problem.rule);
  }
  return rules;
}

TEST(SequenceShape, InvalidSequencesAreRefused) {
  const TriangleMesh sheet = test::flat_sheet(1);
  MeshSequence broken{.triangles = sheet.triangles, .frames = {sheet.vertices, sheet.vertices, sheet.vertices}};
  broken.triangles(0, 0) = 4;
  broken.frames[1](1, 2) = std::numeric_limits<double>::infinity();
  broken.frames[2] = Points::Zero(3, 5);
  broken.frame_rate = 0.0;
  broken.start = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(rules_broken_by({std::make_shared<const MeshSequence>(broken), false}),
              testing::ElementsAre("sequence: frame 1: vertex 2: must be finite",
                                   "sequence: frame 2: must have as many as the first frame, 4",
                                   "sequence: triangle 0: must use vertices from 0 to 3",
                                   "frame_rate: must be greater than 0 and finite", "start: must be finite"));
  EXPECT_THAT(rules_broken_by({std::make_shared<const MeshSequence>(), false}), testing::ElementsAre("sequence: must have frames"));
  EXPECT_THAT(rules_broken_by({}), testing::ElementsAre("sequence: must be given"));
}

Obstacle deforming(std::shared_ptr<const MeshSequence> sequence, bool closed) {
  Obstacle obstacle;
  obstacle.name = "deforming";
  obstacle.geometry = SequenceGeometry{std::move(sequence), closed};
  return obstacle;
}

TEST(DeformingObstacle, ASheetThatRisesThroughAParticleContactsItFromBelow) {
  const ObstacleSet obstacles({deforming(
      sequence_of(test::flat_sheet(4), 2, [](const Vector3& x, int k) { return Vector3(x + Vector3(0.0, 0.2 * k, 0.0)); }),
      false)});
  const Points still = Vector3(0.3, 0.15, 0.4);
  const auto contacts = ObstacleFrame(obstacles, 0.0, 0.1).contacts({still, still, Scalars::Zero(1), 0.0});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].normal, Vector3::UnitY()) << "the particle was above the sheet";
  EXPECT_DOUBLE_EQ(contacts[0].distance, -0.05);
  EXPECT_LT((contacts[0].drift - Vector3(0.0, 0.2, 0.0)).norm(), 1e-15);
}

TEST(DeformingObstacle, AGrownObstacleIsFoundAtItsNewSize) {
  const ObstacleSet obstacles({deforming(
      sequence_of(test::torus(0.1, 0.03, 20, 10), 2, [](const Vector3& x, int k) { return Vector3((1.0 + 99.0 * k) * x); }),
      true)});
  const Points inside = Vector3(10.0, 0.0, 0.0);
  EXPECT_TRUE(test::intersections(ObstacleFrame(obstacles, 0.0, 0.0), inside).empty());
  const ObstacleFrame growing(obstacles, 0.0, 0.1);
  EXPECT_EQ(test::intersections(growing, inside).inside.size(), 1U);
  EXPECT_NEAR(*growing.min_distance(Vector3(13.5, 0.0, 0.0), 1.0), 0.5, 1e-13);
  EXPECT_EQ(test::intersections(growing.part(0.1, 0.1), inside).inside.size(), 1U);
}

TEST(DeformingObstacle, AnObstacleBetweenTwoFramesIsFound) {
  const ObstacleSet obstacles({deforming(
      sequence_of(test::flat_sheet(4), 2, [](const Vector3& x, int k) { return Vector3(x + Vector3(0.0, 3.0 * k, 0.0)); }),
      false)});
  const Points above = Vector3(0.3, 1.6, 0.4);
  EXPECT_FALSE(ObstacleFrame(obstacles, 0.0, 0.0).min_distance(above, 0.2));
  EXPECT_NEAR(*ObstacleFrame(obstacles, 0.0, 0.05).min_distance(above, 0.2), 0.1, 1e-15);
}

TEST(DeformingObstacle, SurfaceVelocityAddsDeformationToMotion) {
  // The sheet is stretched to twice its length along x within 0.1 s and moves along z at 3 m/s.
  Obstacle sheet = deforming(
      sequence_of(test::flat_sheet(4), 2, [](const Vector3& x, int k) { return Vector3((1.0 + k) * x.x(), x.y(), x.z()); }), false);
  sheet.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, 0.0, 3.0}}};
  const ObstacleSet obstacles({sheet});
  // A point at 1.5 m started at 1 m and moves at 10 m/s.
  const Vector3 velocity = ObstacleFrame(obstacles, 0.05, 0.05).surface_velocity(0, {1.5, 0.1, 0.3}, 0.05, 0.01);
  EXPECT_LT((velocity - Vector3(10.0, 0.0, 3.0)).norm(), 1e-12);
}

/// A sheet that is stretched, sheared and rotated within 0.1 s, and stays flat.
TEST(SequenceShape, ElementsMoveWithTheSurface) {
  const auto sequence = sequence_of(test::flat_sheet(8), 2, [](const Vector3& x, int k) {
    return Vector3((1.0 + 0.5 * k) * x.x(), k * (x.x() - 0.3 * x.z() + 2.0), x.z() + 0.4 * k * x.x());
  });
  const MeshShape all_times(SequenceGeometry{sequence, false});
  const auto shape = all_times.in_interval(0.0, 0.1);
  const Vector3 normal = Vector3(-(1.0 + 0.3 * 0.4), 1.5, 0.3 * 1.5).normalized();
  Random random(36);
  for (int trial = 0; trial < 100; ++trial) {
    ElementCorners element{.count = 1 + trial % 3};
    for (Vector3& corner : element.x) corner = random.in_box({Vector3(-1.0, 0.001, -1.0), Vector3(1.0, 0.5, 1.0)});
    const auto moved = shape->moved_element(element);
    ASSERT_TRUE(moved);
    double lowest = 1.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(element.count); ++i) {
      // Coordinates up to 10 m have rounding errors of 2e-15 m, and the axes of a triangle have more.
      EXPECT_NEAR(normal.dot(moved->corners.x[i] - Vector3(0.0, 2.0, 0.0)), element.x[i].y(), 1e-13);
      lowest = std::min(lowest, element.x[i].y());
    }
    EXPECT_NEAR(moved->distance, lowest, 1e-15);
  }
}

}  // namespace
}  // namespace sprung
