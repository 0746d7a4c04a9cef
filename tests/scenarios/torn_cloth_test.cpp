// examples/torn_cloth.json: a spike rises through a cloth in a frame, tears it, and goes back.
#include "base/parallel.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

constexpr double kBreak = 0.25;
constexpr double kSpacing = 0.8 / 28;  // of the particles [m]

BuiltScene torn_cloth() { return load_scenario(SPRUNG_SOURCE_DIR "/examples/torn_cloth"); }

using Side = std::pair<Index, Index>;

/// The sides of triangles that belong to one triangle alone, in its sense.
std::vector<Side> border(const Triangles& triangles) {
  std::map<Side, int> count;
  for (const auto& corners : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % 3];
      ++count[std::minmax(a, b)];
    }
  }
  std::vector<Side> sides;
  for (const auto& corners : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % 3];
      if (count.at(std::minmax(a, b)) == 1) sides.emplace_back(a, b);
    }
  }
  return sides;
}

/// How often directed sides go around the y axis through a point, seen from above.
double turns_around(const Vector3& axis, const std::vector<Side>& sides, const Points& x) {
  double angle = 0.0;
  for (const auto& [a, b] : sides) {
    const Vector3 u = x.col(a) - axis;
    const Vector3 v = x.col(b) - axis;
    angle += std::atan2(u.z() * v.x() - u.x() * v.z(), u.z() * v.z() + u.x() * v.x());
  }
  return angle / (2.0 * std::numbers::pi);
}

double largest_strain(const SpringNetwork& network, const Points& x) {
  double most = 0.0;
  for (Index s = 0; s < network.springs.count(); ++s) {
    const double length = (x.col(network.springs.first[s]) - x.col(network.springs.second[s])).norm();
    most = std::max(most, length / network.springs.rest_length[s] - 1.0);
  }
  return most;
}

TEST(TornCloth, TheSpikeStandsInAHoleOfItsSize) {
  BuiltScene scene = torn_cloth();
  const SpringNetwork whole = scene.network;
  const Index faces = whole.bodies[0].surface.faces.face_count();
  double stretch_of_whole = 0.0;
  std::size_t torn = 0;
  SpringNetwork end;
  Points last;
  Vector3 tip;
  const Watch watch = [&](const Simulator& simulator, const FrameDiagnostics& frame) {
    const Surface& surface = simulator.network().bodies[0].surface;
    ASSERT_GE(surface.torn.size(), torn) << "faces do not come back";
    torn = surface.torn.size();
    ASSERT_EQ(surface.triangles.cols() + static_cast<Index>(torn), faces);
    ASSERT_EQ(simulator.network().particle_count(), whole.particle_count());
    if (torn == 0) stretch_of_whole = frame.max_stretch;
    if (std::abs(frame.time - 1.3) > 1e-6) return;  // when the spike is up
    const Obstacle& spike = simulator.obstacles()[0];
    tip = spike.motion.pose(spike.rest_pose, frame.time) * Vector3(0.0, 0.25, 0.0);
    end = simulator.network();
    last = simulator.positions();
  };
  const ScenarioReport report = run_scenario(std::move(scene), watch, Judge::obstacles_and_self);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
  EXPECT_EQ(torn, end.bodies[0].surface.torn.size()) << "the way back tears nothing";
  EXPECT_GT(stretch_of_whole, 0.5 * kBreak) << "it was pulled before it tore";
  EXPECT_LT(stretch_of_whole, kBreak) << "nothing breaks below its break strain";

  // The border of the cloth goes around the spike once one way, that of the hole once the other way.
  const Surface& surface = end.bodies[0].surface;
  const std::vector<Side> sides = border(surface.triangles);
  std::vector<Side> frame_sides;
  std::vector<Side> hole_sides;
  for (const Side& side : sides)
    (end.is_pinned(side.first) && end.is_pinned(side.second) ? frame_sides : hole_sides).push_back(side);
  EXPECT_EQ(frame_sides.size(), 4U * 28U);
  const double around = turns_around(tip, frame_sides, last);
  EXPECT_NEAR(std::abs(around), 1.0, 1e-9);
  EXPECT_NEAR(turns_around(tip, hole_sides, last), -around, 1e-9) << "the spike stands in the hole";
  EXPECT_LT(last.row(1).maxCoeff(), tip.y()) << "and its tip above the cloth";
  EXPECT_LT(largest_strain(end, last), kBreak) << "what is left holds";

  // The spike is 0.082 m thick where the cloth lies.
  for (const Index face : surface.torn) {
    const Triangles& triangles = whole.bodies[0].surface.triangles;
    const Vector3 middle = (whole.positions.col(triangles(0, face)) + whole.positions.col(triangles(1, face)) +
                            whole.positions.col(triangles(2, face))) /
                           3.0;
    EXPECT_LT((Vector3(middle.x(), tip.y(), middle.z()) - tip).norm(), 0.082 + 3.0 * kSpacing) << face;
  }
}

TEST(TornCloth, AnyNumberOfThreadsTearsAlike) {
  Points first;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    BuiltScene scene = torn_cloth();
    scene.frames = 60;
    Points last;
    std::size_t torn = 0;
    run_scenario(
        std::move(scene),
        [&](const Simulator& simulator, const FrameDiagnostics& /*frame*/) {
          last = simulator.positions();
          torn = simulator.network().bodies[0].surface.torn.size();
        },
        Judge::nothing);
    EXPECT_GT(torn, 0U);
    if (threads == 1) first = last;
    EXPECT_EQ(last, first);
  }
}

}  // namespace
}  // namespace sprung::testing
