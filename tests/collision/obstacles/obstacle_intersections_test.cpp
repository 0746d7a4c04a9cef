#include "collision/obstacles/obstacle_intersections.h"

#include "base/parallel.h"
#include "collision/obstacles/obstacle_frame.h"
#include "collision/sample_meshes.h"
#include "collision/surface/self_intersections.h"
#include "geometry/queries/simplex_crossing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <utility>

namespace sprung {
namespace {

using test::Random;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

Obstacle obstacle(const ObstacleGeometry& geometry, const Vector3& position = Vector3::Zero()) {
  Obstacle result{.name = "obstacle", .geometry = geometry};
  result.rest_pose.translation() = position;
  return result;
}

MeshGeometry mesh_geometry(TriangleMesh mesh, bool closed) { return {std::make_shared<TriangleMesh>(std::move(mesh)), closed}; }

/// Bodies of elements, all of which collide with themselves and each other.
struct Network {
  std::vector<Element> elements{};
  std::vector<Vector3> particles{};
  std::vector<Index> body_of{};

  void add(Index body, const std::vector<Vector3>& corners) {
    Element element{.corners = static_cast<int>(corners.size()), .body = body};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      element.particles[i] = static_cast<Index>(particles.size());
      particles.push_back(corners[i]);
      body_of.push_back(body);
    }
    elements.push_back(element);
  }

  [[nodiscard]] Points positions() const {
    Points x(3, static_cast<Eigen::Index>(particles.size()));
    for (std::size_t i = 0; i < particles.size(); ++i) x.col(static_cast<Eigen::Index>(i)) = particles[i];
    return x;
  }

  [[nodiscard]] CollisionSurface surface(char self = 1, char others = 1) const {
    const auto bodies = static_cast<std::size_t>(body_of.back()) + 1;
    return make_collision_surface(elements, positions(), body_of, Scalars::Zero(static_cast<Eigen::Index>(particles.size())),
                                  ParticleMotions(particles.size()), std::vector<char>(bodies, self),
                                  std::vector<char>(bodies, others));
  }
};

/// Small triangles, segments and points around a mesh.
Network confetti(const TriangleMesh& mesh, int count, double size, Random& random) {
  Network network;
  for (int i = 0; i < count; ++i) {
    const Vector3 middle = test::near_surface(mesh, random, random.between(0.0, 0.1));
    std::vector<Vector3> corners;
    for (int k = 0; k < 1 + i % 3; ++k) corners.push_back(middle + size * random.direction());
    network.add(0, corners);
  }
  return network;
}

/// The crossing elements, each named by its first particle.
std::set<Index> crossing(const Intersections& found, const CollisionSurface& surface) {
  std::set<Index> first_particles;
  for (const auto& [element, k] : found.crossings) {
    first_particles.insert(surface.elements[static_cast<std::size_t>(element)].particles[0]);
  }
  return first_particles;
}

TEST(Intersections, ElementsThatCrossAMeshIntersectOneOfItsTriangles) {
  const TriangleMesh mesh = test::torus(1.0, 0.3, 40, 20);
  Random random(1);
  const Network network = confetti(mesh, 900, 0.05, random);
  Obstacle torus = obstacle(mesh_geometry(mesh, true), Vector3(5.0, -2.0, 1.0));
  torus.rest_pose.linear() = Eigen::AngleAxisd(0.7, Vector3(1, 2, 2) / 3.0).toRotationMatrix();
  const ObstacleSet set({torus});
  const ObstacleFrame frame(set, 0.0, 0.0);

  Points positions = network.positions();
  for (Eigen::Index i = 0; i < positions.cols(); ++i) positions.col(i) = torus.rest_pose * positions.col(i);
  std::set<Index> expected;
  for (const Element& element : network.elements) {
    Simplex simplex{.count = element.corners};
    for (std::size_t k = 0; k < static_cast<std::size_t>(element.corners); ++k) {
      simplex.x[k] = frame.local(0, positions.col(element.particles[k]));
    }
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      const auto corner = mesh.triangles.col(t);
      if (!intersects(simplex, {mesh.vertices.col(corner[0]), mesh.vertices.col(corner[1]), mesh.vertices.col(corner[2])}))
        continue;
      expected.insert(element.particles[0]);
      break;
    }
  }
  EXPECT_GT(expected.size(), 100U);

  const CollisionSurface surface = network.surface();
  EXPECT_EQ(crossing(find_intersections(frame, surface, positions), surface), expected);
  const ThreadLimit one(1);
  EXPECT_EQ(crossing(find_intersections(frame, surface, positions), surface), expected);
}

TEST(Intersections, ParticlesInsideAreFoundOnceWithTheirDepth) {
  const TriangleMesh mesh = test::torus(1.0, 0.3, 40, 20);
  Random random(2);
  const Network network = confetti(mesh, 600, 0.05, random);
  const Points positions = network.positions();
  const ObstacleSet set({obstacle(mesh_geometry(mesh, true)), obstacle(SphereGeometry{0.9})});
  const ObstacleFrame frame(set, 0.0, 0.0);
  std::vector<std::pair<Index, Index>> expected;
  for (Index i = 0; i < positions.cols(); ++i) {
    if (test::winding_number(mesh, positions.col(i)) > 0.5) expected.emplace_back(i, 0);
    if (positions.col(i).norm() < 0.9) expected.emplace_back(i, 1);
  }
  const Intersections found = find_intersections(frame, network.surface(), positions);
  std::vector<std::pair<Index, Index>> inside;
  for (const auto& [particle, k, depth] : found.inside) {
    inside.emplace_back(particle, k);
    // Closest points have errors of a few roundings of coordinates near 1 m.
    const double exact = k == 1 ? 0.9 - positions.col(particle).norm() : test::brute_distance(mesh, positions.col(particle));
    EXPECT_NEAR(depth, exact, 1e-14);
  }
  EXPECT_EQ(inside, expected);
  EXPECT_GT(inside.size(), 100U);
}

TEST(Intersections, TouchingElementsAreReported) {
  const std::vector<ObstacleGeometry> floors{HalfSpaceGeometry{Vector3::UnitY(), 0.0}, BoxGeometry{Vector3(8, 2, 8)},
                                             mesh_geometry(obstacle_mesh(BoxGeometry{Vector3(8, 2, 8)}, 0.0), true),
                                             mesh_geometry(test::flat_sheet(8), false)};
  for (const ObstacleGeometry& floor : floors) {
    SCOPED_TRACE(floor.index());
    const bool is_box = std::holds_alternative<BoxGeometry>(floor) ||
                        (std::holds_alternative<MeshGeometry>(floor) && std::get<MeshGeometry>(floor).closed);
    const ObstacleSet set({obstacle(floor, is_box ? Vector3(-Vector3::UnitY()) : Vector3::Zero())});
    const ObstacleFrame frame(set, 0.0, 0.0);
    for (const double height : {0.0, 0x1p-30, 0.1}) {
      Network network;
      network.add(0, {Vector3(0.1, height, 0.2), Vector3(0.9, height, 0.3), Vector3(0.5, height, 0.9)});
      network.add(0, {Vector3(1.1, height, 0.2), Vector3(1.9, height + 1.0, 0.3)});
      network.add(0, {Vector3(2.1, height, 0.2)});
      const auto found = find_intersections(frame, network.surface(), network.positions());
      EXPECT_EQ(found.crossings.size(), height == 0.0 ? 3U : 0U) << height;
      EXPECT_THAT(found.inside, IsEmpty());
    }
  }
}

TEST(Intersections, ASpikeThroughAFaceIsReportedWithoutAParticleInside) {
  const ConeGeometry spike{0.01, 2.0};
  for (const ObstacleGeometry& geometry :
       {ObstacleGeometry(spike), ObstacleGeometry(mesh_geometry(obstacle_mesh(spike, 0.0), true))}) {
    Network network;
    network.add(0, {Vector3(-1, 0, -1), Vector3(2, 0, -1), Vector3(-1, 0, 2)});
    const ObstacleSet set({obstacle(geometry)});
    const auto found = find_intersections(ObstacleFrame(set, 0.0, 0.0), network.surface(), network.positions());
    EXPECT_THAT(found.inside, IsEmpty());
    ASSERT_EQ(found.crossings.size(), 1U);
    EXPECT_EQ(found.crossings[0].element, 0);
    EXPECT_EQ(found.crossings[0].obstacle, 0);
  }
}

TEST(Intersections, ElementsPinnedInAnObstacleAreNotReported) {
  const ObstacleSet set({obstacle(BoxGeometry{Vector3(2, 2, 2)})});
  const ObstacleFrame frame(set, 0.0, 0.0);
  Network network;
  network.add(0, {Vector3(0, 0.5, 0), Vector3(0, 2, 0)});      // hangs from a pin inside
  network.add(0, {Vector3(0.5, 1.0, 0), Vector3(0.5, 2, 0)});  // hangs from a pin on the surface
  network.add(0, {Vector3(-2, 0, 0), Vector3(2, 0, 0)});       // crosses the box, its pin is outside
  network.add(0, {Vector3(-2, 0, 0), Vector3(2, 0, 0)});       // wholly pinned
  network.add(0, {Vector3(0, 0, 0.3)});
  CollisionSurface surface = network.surface();
  constexpr auto kFree = ParticleMotion::free;
  constexpr auto kAtRest = ParticleMotion::at_rest;
  surface.motions = {kAtRest, kFree, kAtRest, kFree, kAtRest, kFree, kAtRest, kAtRest, kAtRest};
  const Intersections found = find_intersections(frame, surface, network.positions());
  EXPECT_THAT(found.inside, IsEmpty());
  EXPECT_THAT(crossing(found, surface), ElementsAre(4));
}

using Pairs = std::set<std::pair<Index, Index>>;

Pairs self_crossing(const Network& network, char self = 1, char others = 1) {
  const CollisionSurface surface = network.surface(self, others);
  Pairs pairs;
  for (const auto& [first, second] : find_self_intersections(surface, network.positions())) {
    const Index a = surface.elements[static_cast<std::size_t>(first)].particles[0];
    const Index b = surface.elements[static_cast<std::size_t>(second)].particles[0];
    EXPECT_LT(first, second);
    pairs.emplace(std::min(a, b), std::max(a, b));
  }
  return pairs;
}

TEST(SelfIntersections, AllIntersectingPairsAreReported) {
  Random random(3);
  const Network network = confetti(test::torus(1.0, 0.3, 40, 20), 1500, 0.15, random);
  Pairs expected;
  const auto simplex = [&](const Element& element) {
    Simplex corners{.count = element.corners};
    for (std::size_t k = 0; k < static_cast<std::size_t>(element.corners); ++k) {
      corners.x[k] = network.particles[static_cast<std::size_t>(element.particles[k])];
    }
    return corners;
  };
  for (const Element& a : network.elements) {
    for (const Element& b : network.elements) {
      // A particle on a face does not cross it, because nothing of it is on the other side.
      if (a.corners < 2 || b.corners != 3 || a.particles[0] == b.particles[0] || !intersects(simplex(a), simplex(b).x)) continue;
      expected.emplace(std::minmax(a.particles[0], b.particles[0]));
    }
  }
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(self_crossing(network), expected);
  const ThreadLimit one(1);
  EXPECT_EQ(self_crossing(network), expected);
}

TEST(SelfIntersections, NeighboursInASheetDoNotCross) {
  const TriangleMesh sheet = test::terrain(20, [](Index i, Index j) { return std::sin(0.4 * i) * std::cos(0.3 * j); });
  Network network;
  for (Index i = 0; i < sheet.vertices.cols(); ++i) network.particles.emplace_back(sheet.vertices.col(i));
  network.body_of.assign(network.particles.size(), 0);
  for (Index t = 0; t < sheet.triangles.cols(); ++t) {
    network.elements.push_back({{sheet.triangles(0, t), sheet.triangles(1, t), sheet.triangles(2, t)}, 3, 0});
  }
  EXPECT_THAT(self_crossing(network), IsEmpty());

  // A corner is bent through the sheet. Its triangle shares no corner with the triangles that it crosses.
  network.particles[0] = Vector3(-8.5, -1.0, -8.5);
  network.particles[1] = Vector3(-8.2, 2.0, -8.2);
  EXPECT_FALSE(self_crossing(network).empty());
}

TEST(SelfIntersections, TrianglesWithACornerInCommonMayCross) {
  Network network;
  network.particles = {Vector3(0, 0, 0), Vector3(1, 0, 1), Vector3(1, 0, -1), Vector3(1, 1, 0), Vector3(1, -1, 0)};
  network.body_of.assign(5, 0);
  network.elements = {{{0, 1, 2}, 3, 0}, {{0, 3, 4}, 3, 0}};
  // The edge 3-4 intersects the edge 1-2.
  EXPECT_THAT(self_crossing(network), ElementsAre(Pair(0, 0)));
}

TEST(SelfIntersections, OnlyBodiesThatCollideAreTested) {
  Network network;
  const std::vector<Vector3> floor{Vector3(-1, 0, -1), Vector3(2, 0, -1), Vector3(-1, 0, 2)};
  network.add(0, floor);
  network.add(0, {Vector3(0, -1, 0), Vector3(0, 1, 0)});
  network.add(1, {Vector3(0.1, -1, 0), Vector3(0.1, 1, 0)});
  EXPECT_THAT(self_crossing(network, 1, 1), ElementsAre(Pair(0, 3), Pair(0, 5)));
  EXPECT_THAT(self_crossing(network, 1, 0), ElementsAre(Pair(0, 3)));
  EXPECT_THAT(self_crossing(network, 0, 1), ElementsAre(Pair(0, 5)));
  EXPECT_THAT(self_crossing(network, 0, 0), IsEmpty());
}

}  // namespace
}  // namespace sprung
