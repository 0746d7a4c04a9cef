#include "collision/obstacles/environment.h"

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

TEST(Environment, BroadPhaseLosesNoContact) {
  Environment environment(zoo());
  environment.set_interval(0.3, 0.31);
  const Cloud particles = cloud(20000, 0.1);
  const auto contacts = environment.contacts({particles.before, particles.after, particles.thickness, 0.05});

  std::vector<std::pair<Index, Index>> found;
  for (const Contact& contact : contacts) found.emplace_back(contact.particles[0], contact.obstacle);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));

  std::vector<std::pair<Index, Index>> expected;
  std::vector<std::unique_ptr<ObstacleShape>> shapes;
  for (const Obstacle& of : environment.obstacles()) shapes.push_back(make_shape(of.geometry));
  for (Index i = 0; i < particles.before.cols(); ++i) {
    for (Index k = 0; k < std::ssize(shapes); ++k) {
      const Vector3 a = environment.pose_before(k).inverse() * particles.before.col(i);
      const Vector3 b = environment.pose_after(k).inverse() * particles.after.col(i);
      const double reach = particles.thickness[i] + environment.obstacles()[k].material.thickness + 0.05;
      if (shapes[k]->first_crossing(a, b) || shapes[k]->nearest(b, reach)) expected.emplace_back(i, k);
    }
  }
  EXPECT_GT(expected.size(), 2000U);
  EXPECT_EQ(found, expected);
}

TEST(Environment, ContactsAreOnTheSurfaceAndFaceTheBeginOfThePath) {
  int crossed = 0;
  Environment environment(zoo());
  environment.set_interval(0.3, 0.31);
  const Cloud particles = cloud(60000, 0.1);
  for (const Contact& contact : environment.contacts({particles.before, particles.after, particles.thickness, 0.05})) {
    const auto shape = make_shape(environment.obstacles()[contact.obstacle].geometry);
    const Vector3 local = environment.pose_after(contact.obstacle).inverse() * contact.point;
    const auto surface = shape->nearest(local, 1e-9);
    ASSERT_TRUE(surface);
    ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-12);
    ASSERT_NEAR(contact.distance, contact.normal.dot(particles.after.col(contact.particles[0]) - contact.point), 1e-12);
    // If the path crosses the surface, its begin is in front of the contact plane and its end behind it.
    const Vector3 from = environment.pose_before(contact.obstacle).inverse() * particles.before.col(contact.particles[0]);
    const Vector3 to = environment.pose_after(contact.obstacle).inverse() * particles.after.col(contact.particles[0]);
    if (!shape->first_crossing(from, to)) continue;
    ASSERT_GE(contact.normal.dot(environment.pose_after(contact.obstacle) * from - contact.point), -1e-12);
    ASSERT_LE(contact.distance, 1e-12);
    ++crossed;
  }
  EXPECT_GT(crossed, 100);
}

TEST(Environment, SameBitsForAnyNumberOfThreads) {
  Environment environment(zoo());
  environment.set_interval(0.3, 0.31);
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
    result.contacts = environment.contacts({particles.before, particles.after, particles.thickness, 0.05});
    result.after = particles.after;
    const TruncationResult truncation = test::single_particles(environment, 20000).truncate(particles.before, result.after);
    result.truncated = truncation.truncated;
    result.infeasible = truncation.infeasible;
    result.distance = environment.min_distance(result.after, 0.5);
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

TEST(Environment, AnApproachingObstacleMovesItsContact) {
  Obstacle ball = obstacle("ball", SphereGeometry{0.1}, Vector3(-1, 0, 0));
  ball.motion.keyframes = {{0.0}, {0.1, Vector3(2, 0, 0)}};  // 20 m/s
  Environment environment({ball});
  environment.set_interval(0.0, 0.1);
  const Points rest = Vector3::Zero();
  const auto contacts = environment.contacts({rest, rest, Scalars::Constant(1, 0.005), 0.0});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_LT((contacts[0].point - Vector3(1.1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((contacts[0].normal - Vector3::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(contacts[0].distance, -1.1, 1e-12);
}

TEST(Environment, IntersectionsAndDistancesUseTheEndPose) {
  Obstacle ball = obstacle("ball", SphereGeometry{0.5});
  ball.motion.keyframes = {{0.0}, {1.0, Vector3(0, 3, 0)}};
  Environment environment({ball, obstacle("ring", mesh_geometry(test::torus(1.0, 0.3, 30, 15), true), Vector3(5, 0, 0))});
  environment.set_interval(0.9, 1.0);
  Points points(3, 4);
  points.col(0) = Vector3::Zero();
  points.col(1) = Vector3(0, 3.1, 0);
  points.col(2) = Vector3(0, 3.6, 0);
  points.col(3) = Vector3(6, 0, 0);
  const auto inside = test::intersections(environment, points).inside;
  ASSERT_EQ(inside.size(), 2U);
  EXPECT_EQ(inside[0].particle, 1);
  EXPECT_EQ(inside[0].obstacle, 0);
  EXPECT_NEAR(inside[0].depth, 0.4, 1e-15);
  EXPECT_EQ(inside[1].particle, 3);
  EXPECT_EQ(inside[1].obstacle, 1);
  EXPECT_NEAR(inside[1].depth, 0.3, 0.02);  // a ring of 15 sides

  const auto distance_of = [&](Index i) { return environment.min_distance(points.col(i), 0.5); };
  EXPECT_FALSE(distance_of(0));
  EXPECT_NEAR(*distance_of(1), -0.4, 1e-15);
  EXPECT_NEAR(*distance_of(2), 0.1, 1e-15);
  EXPECT_NEAR(*environment.min_distance(points, 0.5), -0.4, 1e-15);
}

TEST(Environment, AnEmptyEnvironmentHasNoContacts) {
  Environment environment;
  const Cloud particles = cloud(100, 0.1);
  Points after = particles.after;
  EXPECT_TRUE(environment.contacts({particles.before, particles.after, particles.thickness, 0.1}).empty());
  EXPECT_EQ(test::single_particles(environment, 100).truncate(particles.before, after).truncated, 0);
  EXPECT_TRUE(test::intersections(environment, after).empty());
  EXPECT_FALSE(environment.min_distance(after, 1.0));
}

TEST(Environment, PositionsThatAreNotFiniteHaveNoContacts) {
  Environment environment({obstacle("floor", HalfSpaceGeometry{}), obstacle("sheet", mesh_geometry(test::flat_sheet(4), false))});
  Points before = Points::Constant(3, 3, 0.001);
  Points after = before;
  after(0, 0) = std::numeric_limits<double>::quiet_NaN();
  after(1, 1) = -std::numeric_limits<double>::infinity();
  const auto contacts = environment.contacts({before, after, Scalars::Constant(3, 0.005), 0.0});
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_EQ(contacts[0].particles[0], 2);
  EXPECT_EQ(test::single_particles(environment, 3).truncate(before, after).truncated, 0);
}

TEST(Environment, EveryInvalidShapeIsReported) {
  try {
    Environment environment(
        {obstacle("ball", SphereGeometry{-1.0}), obstacle("floor", HalfSpaceGeometry{}), obstacle("bunny", MeshGeometry{})});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0].key, "obstacles.ball.shape.radius");
    EXPECT_EQ(error.problems()[1].key, "obstacles.bunny.shape.mesh");
  }
}

TEST(Environment, EveryInvalidMaterialMotionAndPoseIsReported) {
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
    Environment environment({rough, slick, late});
    FAIL();
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) keys.push_back(problem.key);
  }
  EXPECT_THAT(keys, testing::ElementsAre("obstacles.rough.thickness", "obstacles.rough.friction", "obstacles.rough.restitution",
                                         "obstacles.slick.place", "obstacles.slick.thickness", "obstacles.slick.static_friction",
                                         "obstacles.late.shape.radius", "obstacles.late.motion.keyframes[2]",
                                         "obstacles.late.motion.keyframes[1]", "obstacles.late.motion.spin"));
}

}  // namespace
}  // namespace sprung
