#include "collision/obstacles/obstacle_frame.h"

#include "base/error.h"
#include "base/parallel.h"
#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle_shape.h"
#include "collision/single_particles.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace sprung {
namespace {

using test::Random;

Obstacle obstacle(const std::string& name, const ObstacleGeometry& geometry, const Vector3& position = Vector3::Zero()) {
  Obstacle result;
  result.name = name;
  result.geometry = geometry;
  result.rest_pose.translation() = position;
  return result;
}

MeshGeometry mesh_geometry(const TriangleMesh& mesh, bool closed) { return {std::make_shared<const TriangleMesh>(mesh), closed}; }

/// Two obstacles of each kind, within 10 m. Most are rotated and half of them move.
std::vector<Obstacle> zoo() {
  const std::vector<ObstacleGeometry> kinds{mesh_geometry(test::torus(1.0, 0.3, 30, 15), true),
                                            mesh_geometry(test::flat_sheet(4), false),
                                            SphereGeometry{0.7},
                                            BoxGeometry{Vector3(0.6, 1.4, 1.0)},
                                            CapsuleGeometry{0.4, 0.9},
                                            CylinderGeometry{0.5, 1.2},
                                            ConeGeometry{0.6, 1.3},
                                            EllipsoidGeometry{Vector3(0.9, 0.3, 0.6)},
                                            HalfSpaceGeometry{Vector3::UnitY(), -4.0}};
  Random random(21);
  std::vector<Obstacle> result;
  for (std::size_t k = 0; k < 2 * kinds.size(); ++k) {
    Obstacle& added =
        result.emplace_back(obstacle("obstacle_" + std::string(1, static_cast<char>('a' + k)), kinds[k % kinds.size()]));
    if (k % kinds.size() + 1 < kinds.size()) {
      added.rest_pose.translation() = random.in_box({Vector3::Constant(-4.0), Vector3::Constant(4.0)});
      added.rest_pose.linear() = rotation_from_degrees(random.in_box({Vector3::Zero(), Vector3::Constant(360.0)}));
    }
    added.material.thickness = 0.01 * static_cast<double>(k % 3);
    if (k % 2 == 1) {
      added.motion.keyframes = {{0.0}, {1.0, random.direction(), 90.0 * random.direction()}};
      added.motion.spin = 100.0 * random.direction();
    }
  }
  return result;
}

struct Cloud {
  Points before;
  Points after;
  Scalars thickness;
};

/// Strings of neighbouring particles, like ropes and rows of cloth. Each particle moves by up to `reach` [m].
Cloud cloud(Index count, double reach) {
  Random random(22);
  Cloud result{Points(3, count), Points(3, count), Scalars(count)};
  for (Index i = 0; i < count; ++i) {
    result.before.col(i) = i % 64 == 0 ? random.in_box({Vector3::Constant(-5.0), Vector3::Constant(5.0)})
                                       : Vector3(result.before.col(i - 1) + 0.02 * random.direction());
    result.after.col(i) = result.before.col(i) + reach * random.between(0.0, 1.0) * random.direction();
    result.thickness[i] = 0.005 * (1 + i % 3);
  }
  return result;
}

TEST(ObstacleFrame, BroadPhaseLosesNoContact) {
  const ObstacleSet obstacles(zoo());
  const ObstacleFrame frame(obstacles, 0.3, 0.31);
  const Cloud particles = cloud(20000, 0.1);
  const auto contacts = frame.contacts({particles.before, particles.after, particles.thickness, 0.05});

  std::vector<std::pair<Index, Index>> found;
  for (const Contact& contact : contacts) found.emplace_back(contact.particles[0], contact.obstacle);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));

  std::vector<std::pair<Index, Index>> expected;
  std::vector<std::unique_ptr<ObstacleShape>> shapes;
  for (const Obstacle& of : obstacles.obstacles()) shapes.push_back(make_shape(of.geometry));
  for (Index i = 0; i < particles.before.cols(); ++i) {
    for (Index k = 0; k < std::ssize(shapes); ++k) {
      const Vector3 a = frame.before(k).inverse() * particles.before.col(i);
      const Vector3 b = frame.after(k).inverse() * particles.after.col(i);
      const double reach = particles.thickness[i] + obstacles.obstacles()[k].material.thickness + 0.05;
      if (shapes[k]->first_crossing(a, b) || shapes[k]->nearest(b, reach)) expected.emplace_back(i, k);
    }
  }
  EXPECT_GT(expected.size(), 2000U);
  EXPECT_EQ(found, expected);
}

TEST(ObstacleFrame, ContactsAreOnTheSurfaceAndFaceTheBeginOfThePath) {
  int crossed = 0;
  const ObstacleSet obstacles(zoo());
  const ObstacleFrame frame(obstacles, 0.3, 0.31);
  const Cloud particles = cloud(60000, 0.1);
  for (const Contact& contact : frame.contacts({particles.before, particles.after, particles.thickness, 0.05})) {
    const auto shape = make_shape(obstacles.obstacles()[contact.obstacle].geometry);
    const Vector3 local = frame.after(contact.obstacle).inverse() * contact.point;
    const auto surface = shape->nearest(local, 1e-9);
    ASSERT_TRUE(surface);
    ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-12);
    ASSERT_NEAR(contact.distance, contact.normal.dot(particles.after.col(contact.particles[0]) - contact.point), 1e-12);
    // If the path crosses the surface, its begin is in front of the contact plane and its end behind it.
    const Vector3 from = frame.before(contact.obstacle).inverse() * particles.before.col(contact.particles[0]);
    const Vector3 to = frame.after(contact.obstacle).inverse() * particles.after.col(contact.particles[0]);
    if (!shape->first_crossing(from, to)) continue;
    ASSERT_GE(contact.normal.dot(frame.after(contact.obstacle) * from - contact.point), -1e-12);
    ASSERT_LE(contact.distance, 1e-12);
    ++crossed;
  }
  EXPECT_GT(crossed, 100);
}

TEST(ObstacleFrame, SameBitsForAnyNumberOfThreads) {
  const ObstacleSet obstacles(zoo());
  const ObstacleFrame frame(obstacles, 0.3, 0.31);
  const Cloud particles = cloud(20000, 0.3);
  struct Run {
    std::vector<Contact> contacts;
    Points after;
    Index truncated = 0;
    Index infeasible = 0;
    std::optional<double> distance;
  };
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    Run result;
    result.contacts = frame.contacts({particles.before, particles.after, particles.thickness, 0.05});
    result.after = particles.after;
    const TruncationResult truncation = test::single_particles(obstacles, 20000).truncate(frame, particles.before, result.after);
    result.truncated = truncation.truncated;
    result.infeasible = truncation.infeasible;
    result.distance = frame.min_distance(result.after, 0.5);
    return result;
  };
  const Run one = run(1);
  const Run two = run(2);
  ASSERT_EQ(one.contacts.size(), two.contacts.size());
  for (std::size_t i = 0; i < one.contacts.size(); ++i) {
    ASSERT_EQ(one.contacts[i].particles[0], two.contacts[i].particles[0]);
    ASSERT_EQ(one.contacts[i].obstacle, two.contacts[i].obstacle);
    ASSERT_EQ(one.contacts[i].point, two.contacts[i].point);
    ASSERT_EQ(one.contacts[i].normal, two.contacts[i].normal);
    ASSERT_EQ(one.contacts[i].distance, two.contacts[i].distance);
  }
  EXPECT_EQ(one.after, two.after);
  EXPECT_EQ(one.truncated, two.truncated);
  EXPECT_EQ(one.infeasible, two.infeasible);
  EXPECT_EQ(one.distance, two.distance);
}

/// The zoo and a torus that deforms.
std::vector<Obstacle> changing_zoo() {
  std::vector<Obstacle> result = zoo();
  const TriangleMesh mesh = test::torus(1.0, 0.3, 30, 15);
  MeshSequence sequence{.triangles = mesh.triangles, .frames = {}, .frame_rate = 10.0};
  for (int k = 0; k < 6; ++k) {
    Points& frame = sequence.frames.emplace_back(mesh.vertices);
    frame.row(0) *= 1.0 + 0.3 * std::sin(k);
    frame.row(1).array() += 0.2 * k;
  }
  result.push_back(obstacle("deforming", SequenceGeometry{std::make_shared<const MeshSequence>(std::move(sequence)), true}));
  return result;
}

/// What a frame answers about these particles.
std::vector<double> answers(const ObstacleFrame& frame, const Cloud& particles) {
  std::vector<double> all{frame.max_displacement(particles.before)};
  const auto append = [&](const auto& values) {
    for (const double value : values.reshaped()) all.push_back(value);
  };
  for (const Contact& contact : frame.contacts({particles.before, particles.after, particles.thickness, 0.05})) {
    all.push_back(contact.particles[0]);
    all.push_back(contact.obstacle);
    all.push_back(contact.clearance);
    append(contact.point);
    append(contact.normal);
    append(contact.drift);
  }
  std::vector<Index> near;
  for (Index k = 0; k < static_cast<Index>(frame.set().obstacles().size()); ++k) {
    const Vector3 p = particles.before.col(k);
    append(frame.before(k).matrix());
    append(frame.after(k).matrix());
    append(frame.moved_position(k, p));
    append(frame.surface_velocity(k, p, frame.begin(), 0.01));
    all.push_back(frame.is_at_rest(k) ? 1.0 : 0.0);
    frame.find_near({p - Vector3::Constant(0.5), p + Vector3::Constant(0.5)}, near);
    all.insert(all.end(), near.begin(), near.end());
  }
  all.push_back(frame.min_distance(particles.after, 0.5).value_or(1.0));
  return all;
}

/// Within a frame of the sequence, at frames, across several of them, and back in time.
constexpr std::pair<double, double> kIntervals[] = {{0.0, 0.0}, {0.3, 0.31}, {0.305, 0.31}, {0.1, 0.2}, {0.05, 0.45}, {0.2, 0.1}};

TEST(ObstacleFrame, IsAValueThatOtherFramesDoNotChange) {
  const ObstacleSet obstacles(changing_zoo());
  const Cloud particles = cloud(4000, 0.1);
  std::vector<ObstacleFrame> frames;
  std::vector<std::vector<double>> answers_at_first;
  for (const auto& [begin, end] : kIntervals) {
    frames.emplace_back(obstacles, begin, end);
    answers_at_first.push_back(answers(frames.back(), particles));
  }
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(answers(frames[k], particles), answers_at_first[k]) << k;
}

TEST(ObstacleFrame, DependsOnItsIntervalAlone) {
  const ObstacleSet diverted(changing_zoo());
  const Cloud particles = cloud(4000, 0.1);
  const ObstacleFrame whole(diverted, 0.0, 0.5);
  for (const auto& [begin, end] : kIntervals) {
    const ObstacleSet fresh(changing_zoo());
    const std::vector<double> expected = answers(ObstacleFrame(fresh, begin, end), particles);
    EXPECT_EQ(answers(ObstacleFrame(diverted, begin, end), particles), expected) << begin << " to " << end;
    EXPECT_EQ(answers(whole.part(begin, end), particles), expected) << begin << " to " << end;
  }
}

TEST(ObstacleFrame, OfObstaclesThatNeverMoveSharesAllData) {
  std::vector<Obstacle> still = zoo();
  for (Obstacle& each : still) each.motion = {};
  const ObstacleSet obstacles(still);
  const ObstacleFrame first(obstacles, 0.0, 0.01);
  const ObstacleFrame second(obstacles, 7.0, 8.0);
  for (Index k = 0; k < std::ssize(still); ++k) {
    EXPECT_EQ(&first.after(k), &second.after(k));
    EXPECT_EQ(&first.shape(k), &obstacles.shape(k));
    EXPECT_TRUE(second.is_at_rest(k));
  }
  EXPECT_EQ(second.begin(), 7.0);
  EXPECT_EQ(second.end(), 8.0);
}

TEST(ObstacleFrame, AnApproachingObstacleMovesItsContact) {
  Obstacle ball = obstacle("ball", SphereGeometry{0.1}, Vector3(-1, 0, 0));
  ball.motion.keyframes = {{0.0}, {0.1, Vector3(2, 0, 0)}};  // 20 m/s
  const ObstacleSet obstacles({ball});
  const ObstacleFrame frame(obstacles, 0.0, 0.1);
  const Points rest = Vector3::Zero();
  const auto contacts = frame.contacts({rest, rest, Scalars::Constant(1, 0.005), 0.0});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_LT((contacts[0].point - Vector3(1.1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((contacts[0].normal - Vector3::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(contacts[0].distance, -1.1, 1e-12);
}

TEST(ObstacleFrame, IntersectionsAndDistancesUseTheEndPose) {
  Obstacle ball = obstacle("ball", SphereGeometry{0.5});
  ball.motion.keyframes = {{0.0}, {1.0, Vector3(0, 3, 0)}};
  const ObstacleSet obstacles({ball, obstacle("ring", mesh_geometry(test::torus(1.0, 0.3, 30, 15), true), Vector3(5, 0, 0))});
  const ObstacleFrame frame(obstacles, 0.9, 1.0);
  Points points(3, 4);
  points.col(0) = Vector3::Zero();
  points.col(1) = Vector3(0, 3.1, 0);
  points.col(2) = Vector3(0, 3.6, 0);
  points.col(3) = Vector3(6, 0, 0);
  const auto inside = test::intersections(frame, points).inside;
  ASSERT_EQ(inside.size(), 2U);
  EXPECT_EQ(inside[0].particle, 1);
  EXPECT_EQ(inside[0].obstacle, 0);
  EXPECT_NEAR(inside[0].depth, 0.4, 1e-15);
  EXPECT_EQ(inside[1].particle, 3);
  EXPECT_EQ(inside[1].obstacle, 1);
  EXPECT_NEAR(inside[1].depth, 0.3, 0.02);  // a ring of 15 sides

  const auto distance_of = [&](Index i) { return frame.min_distance(points.col(i), 0.5); };
  EXPECT_FALSE(distance_of(0));
  EXPECT_NEAR(*distance_of(1), -0.4, 1e-15);
  EXPECT_NEAR(*distance_of(2), 0.1, 1e-15);
  EXPECT_NEAR(*frame.min_distance(points, 0.5), -0.4, 1e-15);
}

TEST(ObstacleFrame, OfNoObstaclesHasNoContacts) {
  const ObstacleSet obstacles;
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  const Cloud particles = cloud(100, 0.1);
  Points after = particles.after;
  EXPECT_TRUE(frame.contacts({particles.before, particles.after, particles.thickness, 0.1}).empty());
  EXPECT_EQ(test::single_particles(obstacles, 100).truncate(frame, particles.before, after).truncated, 0);
  EXPECT_TRUE(test::intersections(frame, after).empty());
  EXPECT_FALSE(frame.min_distance(after, 1.0));
}

TEST(ObstacleFrame, PositionsThatAreNotFiniteHaveNoContacts) {
  const ObstacleSet obstacles(
      {obstacle("floor", HalfSpaceGeometry{}), obstacle("sheet", mesh_geometry(test::flat_sheet(4), false))});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  Points before = Points::Constant(3, 3, 0.001);
  Points after = before;
  after(0, 0) = std::numeric_limits<double>::quiet_NaN();
  after(1, 1) = -std::numeric_limits<double>::infinity();
  const auto contacts = frame.contacts({before, after, Scalars::Constant(3, 0.005), 0.0});
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_EQ(contacts[0].particles[0], 2);
  EXPECT_EQ(test::single_particles(obstacles, 3).truncate(frame, before, after).truncated, 0);
}

TEST(ObstacleSet, EveryInvalidShapeIsReported) {
  try {
    const ObstacleSet obstacles(
        {obstacle("ball", SphereGeometry{-1.0}), obstacle("floor", HalfSpaceGeometry{}), obstacle("bunny", MeshGeometry{})});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0].key, "obstacles.ball.shape.radius");
    EXPECT_EQ(error.problems()[1].key, "obstacles.bunny.shape.mesh");
  }
}

TEST(ObstacleSet, EveryInvalidMaterialMotionAndPoseIsReported) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Obstacle rough = obstacle("rough", SphereGeometry{1.0});
  rough.material = {.thickness = -0.1, .friction = -0.2, .static_friction = 0.1, .restitution = 1.5};
  Obstacle slick = obstacle("slick", SphereGeometry{1.0}, Vector3(0.0, kNan, 0.0));
  slick.material = {.thickness = std::numeric_limits<double>::infinity(), .friction = 0.3, .static_friction = 0.2};
  Obstacle late = obstacle("late", SphereGeometry{-1.0});
  late.motion.keyframes = {{1.0}, {0.5}, {2.0, Vector3(kNan, 0.0, 0.0)}};
  late.motion.spin.z() = kNan;
  std::vector<std::string> keys;
  try {
    const ObstacleSet obstacles({rough, slick, late});
    FAIL();
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) keys.push_back(problem.key);
  }
  EXPECT_THAT(keys,
              testing::ElementsAre("obstacles.rough.thickness", "obstacles.rough.friction", "obstacles.rough.restitution",
                                   "obstacles.slick.rest_pose", "obstacles.slick.thickness", "obstacles.slick.static_friction",
                                   "obstacles.late.shape.radius", "obstacles.late.motion.keyframes[2]",
                                   "obstacles.late.motion.keyframes[1]", "obstacles.late.motion.spin"));
}

// Without this rule a sphere with a scaled pose keeps its radius, and moves otherwise than it is drawn.
TEST(ObstacleSet, APoseIsARotationAndATranslation) {
  Obstacle scaled = obstacle("", SphereGeometry{1.0});
  scaled.rest_pose.linear() *= 2.0;
  Obstacle reflected = obstacle("mirror", SphereGeometry{1.0});
  reflected.rest_pose.linear()(1, 1) = -1.0;
  try {
    const ObstacleSet obstacles({scaled, reflected});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0].key, "obstacles[0].rest_pose");
    EXPECT_EQ(error.problems()[1].key, "obstacles.mirror.rest_pose");
    EXPECT_EQ(error.problems()[1].value, "a reflection");
  }
}

}  // namespace
}  // namespace sprung
