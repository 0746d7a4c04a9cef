// A particle without thickness keeps a clearance, however long it slides along surfaces and over edges.
#include "collision/sample_meshes.h"
#include "collision/single_particles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

using test::Random;

// The promised range of the clearance, as fractions of the coordinates: far above rounding, far below what is visible.
constexpr double kMin = 1e-10;
constexpr double kMax = 1e-8;

Obstacle obstacle(const ObstacleGeometry& geometry, const Vector3& position = Vector3::Zero(),
                  const Vector3& degrees = Vector3::Zero()) {
  Obstacle result;
  result.name = "obstacle";
  result.geometry = geometry;
  result.rest_pose.translation() = position;
  result.rest_pose.linear() = rotation_from_degrees(degrees);
  return result;
}

ObstacleGeometry mesh_of(const TriangleMesh& mesh, bool closed) {
  return MeshGeometry{std::make_shared<const TriangleMesh>(mesh), closed};
}

ObstacleGeometry mesh_of(const ObstacleGeometry& primitive) { return mesh_of(obstacle_mesh(primitive, 0.0), true); }

/// One step without thickness: projects each particle onto its contacts' planes, then truncates. Returns the number of truncated
/// particles.
Index step_to(const ObstacleFrame& frame, StepTruncation& truncation, Points& x, const Points& wanted) {
  Points after = wanted;
  for (const Contact& contact : frame.contacts({x, wanted, Scalars::Zero(x.cols()), 0.0})) {
    auto position = after.col(contact.particles[0]);
    const double depth = contact.clearance - contact.normal.dot(position - contact.point);
    if (depth > 0.0) position += depth * contact.normal;
  }
  const TruncationResult result = truncation.truncate(frame, x, after);
  EXPECT_EQ(result.infeasible, 0);
  x = after;
  return result.truncated;
}

struct Slide {
  const char* name;
  ObstacleGeometry geometry;
  double top;  ///< height of its flat upper surface [m]
};

std::vector<Slide> flat_surfaces() {
  return {{"half-space", HalfSpaceGeometry{}, 0.0},
          {"raised half-space", HalfSpaceGeometry{Vector3::UnitY(), 0.3}, 0.3},
          {"box", BoxGeometry{Vector3(8.0, 1.0, 8.0)}, 0.5},
          {"cylinder", CylinderGeometry{4.0, 1.0}, 0.5},
          {"closed mesh", mesh_of(BoxGeometry{Vector3(8.0, 1.0, 8.0)}), 0.5},
          {"open mesh", mesh_of(test::flat_sheet(8), false), 0.0}};
}

// At the origin, and moved and rotated away from it.
TEST(Clearance, PressedParticlesSlideAlongFlatSurfacesWithoutTruncation) {
  for (const Slide& slide : flat_surfaces()) {
    for (const bool away : {false, true}) {
      SCOPED_TRACE(std::string(slide.name) + (away ? ", away" : ""));
      const ObstacleSet obstacles(
          {away ? obstacle(slide.geometry, Vector3(3.7, -8.1, 5.3), Vector3(20.0, 50.0, -35.0)) : obstacle(slide.geometry)});
      const ObstacleFrame frame(obstacles, 0.0, 0.0);
      const RigidTransform& pose = frame.after(0);
      const Vector3 motion = pose.linear() * Vector3(0.013, -0.02, 0.007);
      const Vector3 start(-1.5, slide.top + 0.01, -1.0);
      StepTruncation truncation = test::single_particles(obstacles, 1);
      Points x = pose * start;
      for (int step = 1; step <= 200; ++step) {
        ASSERT_EQ(step_to(frame, truncation, x, x + motion), 0U) << step;
        const Vector3 local = pose.inverse() * x.col(0);
        // 200 sums and projections, each right to a few roundings of coordinates of 10 m.
        ASSERT_NEAR(local.x(), start.x() + 0.013 * step, 1e-11);
        ASSERT_NEAR(local.z(), start.z() + 0.007 * step, 1e-11);
        ASSERT_GT(local.y() - slide.top, kMin * x.cwiseAbs().maxCoeff());
        ASSERT_LT(local.y() - slide.top, kMax * 20.0);
      }
    }
  }
}

TEST(Clearance, PressedParticlesSlideAroundConvexBodiesWithoutTruncation) {
  const SphereGeometry ball{1.0};
  const ObstacleGeometry bodies[] = {ball,
                                     CapsuleGeometry{1.0, 0.5},
                                     EllipsoidGeometry{Vector3(1.0, 0.6, 1.3)},
                                     ConeGeometry{1.0, 2.0},
                                     BoxGeometry{Vector3(1.0, 1.5, 2.0)},
                                     mesh_of(ball),
                                     mesh_of(BoxGeometry{Vector3(1.0, 1.5, 2.0)})};
  for (std::size_t k = 0; k < std::size(bodies); ++k) {
    SCOPED_TRACE(k);
    const ObstacleSet obstacles({obstacle(bodies[k], Vector3(0.7, 0.2, -0.4), Vector3(10.0, 20.0, 30.0))});
    const ObstacleFrame frame(obstacles, 0.0, 0.0);
    const Vector3 centre = frame.after(0).translation();
    const Vector3 axis = Vector3(0.3, -0.2, 1.0).normalized();
    StepTruncation truncation = test::single_particles(obstacles, 1);
    Points x = centre + 3.0 * Vector3::UnitY();
    double turned = 0.0;
    for (int step = 0; step < 2000; ++step) {
      const Vector3 from = x.col(0) - centre;
      const Vector3 along = axis.cross(from).normalized();
      ASSERT_EQ(step_to(frame, truncation, x, x + 0.02 * along - 0.005 * from.normalized()), 0U) << step;
      const Vector3 to = x.col(0) - centre;
      turned += std::atan2(axis.dot(from.cross(to)), from.dot(to));
      ASSERT_TRUE(test::intersections(frame, x).empty());
    }
    EXPECT_GT(turned, 2.0 * std::numbers::pi);
  }
}

// Truncation alone, as if projections did not converge. At the origin, where coordinates are small, the height is most at risk.
TEST(Clearance, RepeatedTruncationKeepsTheHeight) {
  for (const Slide& slide : flat_surfaces()) {
    SCOPED_TRACE(slide.name);
    const ObstacleSet obstacles({obstacle(slide.geometry)});
    const ObstacleFrame frame(obstacles, 0.0, 0.0);
    Points x = Vector3(0.0, slide.top + 0.01, 0.0);
    StepTruncation truncation = test::single_particles(obstacles, 1);
    double settled = 0.0;
    for (int step = 0; step < 5000; ++step) {
      Points after = x - 0.05 * Vector3::UnitY();
      truncation.truncate(frame, x, after);
      x = after;
      ASSERT_GT(x(1, 0) - slide.top, kMin * 0.05) << step;
      if (step == 100) settled = x(1, 0);
    }
    EXPECT_EQ(x(1, 0), settled);
  }
}

TEST(Clearance, AParticlePressedOnARestingObstacleKeepsItsPositionToTheLastBit) {
  for (const Slide& slide : flat_surfaces()) {
    SCOPED_TRACE(slide.name);
    const ObstacleSet obstacles({obstacle(slide.geometry, Vector3(3.7, -8.1, 5.3), Vector3(20.0, 50.0, -35.0))});
    const ObstacleFrame frame(obstacles, 0.0, 0.0);
    const RigidTransform& pose = frame.after(0);
    const Vector3 down = pose.linear() * -Vector3::UnitY();
    Points x = pose * Vector3(0.2, slide.top + 0.01, 0.3);
    StepTruncation truncation = test::single_particles(obstacles, 1);
    for (int step = 0; step < 100; ++step) {
      Points after = x + 0.05 * down;
      truncation.truncate(frame, x, after);
      x = after;
    }
    Points after = x + 0.05 * down;
    EXPECT_EQ(truncation.truncate(frame, x, after).truncated, 1);
    EXPECT_EQ(after, x);
  }
}

TEST(Clearance, AParticleOnAMovingObstacleKeepsItsClearance) {
  for (const Slide& slide : flat_surfaces()) {
    SCOPED_TRACE(slide.name);
    Obstacle carousel = obstacle(slide.geometry, Vector3(0.7, -0.1, 0.3), Vector3(20.0, 50.0, -35.0));
    carousel.motion.spin = Vector3(300.0, 700.0, -500.0);
    const ObstacleSet obstacles({carousel});
    Points x = ObstacleFrame(obstacles, 0.0, 0.0).after(0) * Vector3(0.2, slide.top + 0.01, 0.3);
    StepTruncation truncation = test::single_particles(obstacles, 1);
    for (int step = 0; step < 20000; ++step) {
      const ObstacleFrame frame(obstacles, 0.001 * step, 0.001 * (step + 1));
      const Vector3 moved = frame.after(0) * (frame.before(0).inverse() * x.col(0));
      Points after = moved - 0.05 * (frame.after(0).linear() * Vector3::UnitY());
      ASSERT_EQ(truncation.truncate(frame, x, after).infeasible, 0);
      x = after;
      const Vector3 local = frame.after(0).inverse() * x.col(0);
      ASSERT_GT(local.y() - slide.top, kMin * x.cwiseAbs().maxCoeff()) << step;
    }
  }
}

Vector3 times(double scale, const Vector3& v) { return scale * v; }

/// Moves particles at random among a box, a ball, a sheet, a floor and a rotating mesh, all lengths times `scale`.
Points scaled_run(double scale) {
  TriangleMesh torus = test::torus(1.0, 0.3, 20, 10);
  torus.vertices *= scale;
  TriangleMesh sheet = test::flat_sheet(4);
  sheet.vertices *= scale;
  std::vector<Obstacle> all{obstacle(HalfSpaceGeometry{}),
                            obstacle(BoxGeometry{times(scale, Vector3(1.0, 0.4, 0.7))}, times(scale, Vector3(0.3, 0.2, 1.0))),
                            obstacle(SphereGeometry{0.5 * scale}, times(scale, Vector3(-1.0, 0.4, 0.0))),
                            obstacle(mesh_of(sheet, false), times(scale, Vector3(0.0, 2.0, 0.0)), Vector3(10.0, 0.0, 20.0)),
                            obstacle(mesh_of(torus, true), times(scale, Vector3(1.5, 0.9, -0.5)))};
  all.back().motion.spin = Vector3(0.0, 500.0, 100.0);
  const ObstacleSet obstacles(all);
  Random random(41);
  StepTruncation truncation = test::single_particles(obstacles, 300);
  Points x(3, 300);
  for (Index i = 0; i < x.cols(); ++i) x.col(i) = scale * random.in_box({Vector3(-2.0, 2.5, -2.0), Vector3(2.0, 4.0, 2.0)});
  for (int step = 0; step < 60; ++step) {
    const ObstacleFrame frame(obstacles, 0.01 * step, 0.01 * (step + 1));
    Points wanted = x;
    for (Index i = 0; i < x.cols(); ++i) wanted.col(i) += scale * (0.1 * random.direction() - 0.08 * Vector3::UnitY());
    step_to(frame, truncation, x, wanted);
  }
  return x;
}

TEST(Clearance, ResultsScaleWithTheSceneBitForBit) {
  const Points x = scaled_run(1.0);
  EXPECT_EQ(scaled_run(128.0), 128.0 * x);
  EXPECT_EQ(scaled_run(1.0 / 128.0), x / 128.0);
}

}  // namespace
}  // namespace sprung
