// Bodies worn round each other that cross by a little at the start: push_out moves them by the overlap and the gap, to one side of
// each other everywhere, as the judge confirms, and the run continues from there.
#include "base/parallel.h"
#include "collision/sample_meshes.h"
#include "network/network_builder.h"
#include "scenarios/judge.h"
#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

constexpr double kGap = 0.002;  // [m], the thickness of all bodies
constexpr double kPi = std::numbers::pi;

const SpringMaterials kSprings{.structural = SpringMaterial{.value = 50.0, .damping = 0.01},
                               .shear = SpringMaterial{.value = 25.0, .damping = 0.005},
                               .bend = {}};

BodyShape body_of(const TriangleMesh& triangles) { return make_mesh_body(test::polygons(triangles), kSprings); }

SpringNetwork network_of(const std::vector<BodyShape>& shapes, bool self_contact = true) {
  NetworkBuilder builder;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    BodyShape shape = shapes[k];
    set_total_mass(shape, 0.2);
    builder.add_body("body" + std::to_string(k), shape, {.thickness = kGap}, {.self = self_contact});
  }
  return builder.build();
}

/// Rings of `around` vertices about the y axis; `point(ring, angle)`. With `capped`, the first and the last ring are closed.
template <class PointOf>
TriangleMesh turned(Index rings, Index around, const PointOf& point, bool capped) {
  TriangleMesh mesh{.vertices = Points(3, rings * around + (capped ? 2 : 0)), .triangles = {}};
  std::vector<Eigen::Matrix<Index, 3, 1>> triangles;
  for (Index j = 0; j < rings; ++j) {
    for (Index i = 0; i < around; ++i) {
      const Index next = (i + 1) % around;
      mesh.vertices.col(j * around + i) = point(j, 2.0 * kPi * i / around);
      if (j + 1 == rings) continue;
      triangles.emplace_back(j * around + i, (j + 1) * around + i, (j + 1) * around + next);
      triangles.emplace_back(j * around + i, (j + 1) * around + next, j * around + next);
    }
  }
  for (const Index end : capped ? std::vector<Index>{0, 1} : std::vector<Index>{}) {
    const Index pole = rings * around + end;
    mesh.vertices.col(pole) = point(end == 0 ? -1 : rings, 0.0);
    for (Index i = 0; i < around; ++i) {
      const Index a = end * (rings - 1) * around + i;
      const Index b = end * (rings - 1) * around + (i + 1) % around;
      triangles.emplace_back(pole, end == 0 ? a : b, end == 0 ? b : a);
    }
  }
  mesh.triangles.resize(3, std::ssize(triangles));
  for (std::size_t t = 0; t < triangles.size(); ++t) mesh.triangles.col(static_cast<Index>(t)) = triangles[t];
  return mesh;
}

constexpr Index kAround = 24;
constexpr Index kFine = 90;

/// An open tube 0.5 m long whose radius is mean + wave cos(waves angle), turned by `turn` degrees and moved along its axis.
TriangleMesh tube(double mean, double wave, int waves, double turn = 0.0, double shift = 0.0, Index around = kAround) {
  const auto point = [&](Index ring, double angle) {
    const double at = angle + turn * kPi / 180.0;
    const double radius = mean + wave * std::cos(waves * at);
    return Vector3(radius * std::cos(at), shift - 0.25 + 0.5 * static_cast<double>(ring) / 6.0, radius * std::sin(at));
  };
  return turned(7, around, point, false);
}

BodyShape tube_body(double mean, double wave, int waves, double turn = 0.0, double shift = 0.0) {
  return body_of(tube(mean, wave, waves, turn, shift));
}

/// The mesh with every third face reversed.
TriangleMesh mixed_winding(TriangleMesh mesh) {
  for (Index t = 0; t < mesh.triangles.cols(); t += 3) std::swap(mesh.triangles(1, t), mesh.triangles(2, t));
  return mesh;
}

/// How far the faces of a tube lie below the circle through their vertices [m].
double sagitta(double radius, double sector) { return radius * (1.0 - std::cos(0.5 * sector)); }

constexpr Index kMeridians = 32;
constexpr Index kParallels = 20;

/// A closed sphere with bumps of `wave` [m], turned by `turn` degrees.
BodyShape sphere(double mean, double wave, double turn = 0.0) {
  const auto point = [&](Index ring, double angle) {
    const double at = angle + turn * kPi / 180.0;
    const double latitude = kPi * (static_cast<double>(ring + 1) / kParallels - 0.5);
    const double radius = mean + wave * std::cos(3.0 * at) * std::cos(latitude);
    return Vector3(radius * Vector3(std::cos(latitude) * std::cos(at), std::sin(latitude), std::cos(latitude) * std::sin(at)));
  };
  return body_of(turned(kParallels - 1, kMeridians, point, true));
}

BodyShape box(Index cells) { return make_solid({.size = Vector3::Constant(0.4), .resolution = {cells, cells, cells}}, kSprings); }

/// A sheet of 0.36 m above the middle of box(), whose ripples dip 5 mm below its top. Their curvature is 0.008 m (25/m)^2 = 5/m.
BodyShape rippled_sheet() {
  TriangleMesh sheet = test::terrain(36, [](Index i, Index j) { return 0.3 + 0.8 * std::sin(0.25 * i) * std::sin(0.25 * j); });
  sheet.vertices *= 0.01;
  sheet.vertices.row(1).array() += 0.2;
  return body_of(sheet);
}

/// A tube 0.1 m long with cells of 11 to 13 mm.
BodyShape fine_tube(double mean, double wave) {
  const auto point = [&](Index ring, double angle) {
    const double radius = mean + wave * std::cos(2.0 * angle);
    return Vector3(radius * std::cos(angle), 0.0125 * static_cast<double>(ring), radius * std::sin(angle));
  };
  return body_of(turned(9, kFine, point, false));
}

/// A cloth of 1 m, tilted by 3 degrees, that cuts the top of box() along two of its edges and is beside it beyond them.
BodyShape tilted_cloth() {
  BodyShape cloth = make_cloth({.size = {1.0, 1.0}, .resolution = {21, 21}}, kSprings);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-87.0, 0.0, 0.0});
  pose.translation() = Vector3(0.0, 0.203, 0.0);
  place(cloth, pose, Vector3::Zero());
  return cloth;
}

/// A rope along x that dips `depth` [m] below the plane y = 0 in three places.
BodyShape weaving_rope(double depth) {
  std::vector<Vector3> points;
  for (int k = 0; k <= 60; ++k) points.emplace_back(0.015 * k - 0.45, 0.002 - (depth + 0.002) * std::sin(0.3 * k), 0.03);
  return make_rope({.points = points, .particles = 61, .length = {}}, kSprings);
}

SimulatorSettings pushing_out() {
  SimulatorSettings settings{.step = 2.0e-4, .gravity = Vector3::Zero()};
  settings.contact.start = ContactSettings::Start::push_out;
  return settings;
}

struct LayersCase {
  std::string name;
  std::vector<BodyShape> bodies;
  double most = 0.0;  ///< upper bound of a displacement [m]
};

std::ostream& operator<<(std::ostream& stream, const LayersCase& layers) { return stream << layers.name; }

class EveryPairOfLayers : public ::testing::TestWithParam<LayersCase> {};

void expect_apart_near(const std::vector<BodyShape>& bodies, double most, bool self_contact = true) {
  const SpringNetwork network = network_of(bodies, self_contact);
  const std::vector<JudgedElement> elements = judged_elements(network);
  EXPECT_GT(count_self_crossings(elements, network.positions), 0);

  Simulator simulator(network, pushing_out(), {});
  EXPECT_EQ(count_self_crossings(elements, simulator.positions()), 0);
  // Passes end within a thousandth of the gap.
  EXPECT_LE((simulator.positions() - network.positions).colwise().norm().maxCoeff(), most + 1e-3 * kGap);

  for (int step = 0; step < 50; ++step) {
    simulator.step();
    ASSERT_EQ(count_self_crossings(elements, simulator.positions()), 0);
  }
}

TEST_P(EveryPairOfLayers, MovesByTheOverlapAndTheGapInBothOrders) {
  auto [name, bodies, most] = GetParam();
  expect_apart_near(bodies, most);
  std::reverse(bodies.begin(), bodies.end());
  expect_apart_near(bodies, most);
}

/// The bounds are overlap + gap, and for facets twice the sagitta: those of one layer must clear the vertices of the other.
std::vector<LayersCase> layers() {
  const double tube_facets = 2.0 * sagitta(0.166, 2.0 * kPi / kAround);
  const double sphere_facets = 2.0 * (sagitta(0.206, 2.0 * kPi / kMeridians) + sagitta(0.206, kPi / kParallels));
  // Of cells of 25 mm on ripples with a curvature of 5/m along both of their sides.
  const double solid_facets = 2.0 * 5.0 * 0.025 * 0.025 / 8.0;
  std::vector<LayersCase> result;
  for (const double turn : {0.0, 3.0, 7.5, 22.0}) {
    result.push_back({"TubesTurnedBy" + std::to_string(static_cast<int>(turn)),
                      {tube_body(0.16, 0.006, 2), tube_body(0.163, 0.0, 0, turn)},
                      0.003 + kGap + tube_facets});
    result.push_back({"SpheresTurnedBy" + std::to_string(static_cast<int>(turn)),
                      {sphere(0.2, 0.006), sphere(0.203, 0.0, turn)},
                      0.003 + kGap + sphere_facets});
  }
  result.push_back(
      {"TubesThatEndElsewhere", {tube_body(0.16, 0.006, 2), tube_body(0.163, 0.0, 0, 3.0, 0.17)}, 0.003 + kGap + tube_facets});
  // Faces that are wound either way.
  result.push_back({"TubesOfMixedWinding",
                    {body_of(mixed_winding(tube(0.16, 0.006, 2))), body_of(mixed_winding(tube(0.163, 0.0, 0, 3.0)))},
                    0.003 + kGap + tube_facets});
  // Neither is the outer one.
  result.push_back({"TubesOfTheSameMean", {tube_body(0.16, 0.006, 2), tube_body(0.16, 0.0, 0, 3.0)}, 0.006 + kGap + tube_facets});
  // Every particle is in the other surface. The corners of a box move along its diagonals.
  result.push_back({"EqualTubes", {tube_body(0.16, 0.006, 2), tube_body(0.16, 0.006, 2)}, kGap + tube_facets});
  result.push_back({"EqualBoxes", {box(6), box(5)}, std::sqrt(3.0) * kGap});
  result.push_back({"ASheetWithRipplesInASolid", {box(17), rippled_sheet()}, 0.005 + kGap + solid_facets});
  result.push_back({"TubesThatOverlapByMoreThanACell",
                    {fine_tube(0.16, 0.02), fine_tube(0.16, 0.0)},
                    0.02 + kGap + 2.0 * sagitta(0.18, 2.0 * kPi / kFine)});
  result.push_back({"ARopeThatWeavesThroughACloth", {body_of(test::flat_sheet(2)), weaving_rope(0.009)}, 0.009 + kGap});
  return result;
}

INSTANTIATE_TEST_SUITE_P(LayersScenario, EveryPairOfLayers, ::testing::ValuesIn(layers()),
                         [](const auto& of) { return of.param.name; });

TEST(LayersScenario, ThreeTubesAreWornInEveryOrder) {
  const std::array tubes{tube_body(0.16, 0.006, 2), tube_body(0.163, 0.0, 0, 5.0), tube_body(0.165, 0.003, 3)};
  // The innermost reaches 0.166 m, the outermost 0.162: 4 mm of overlap, two gaps, and the facets of four surfaces between them.
  const double most = 0.004 + 2.0 * kGap + 4.0 * sagitta(0.168, 2.0 * kPi / kAround);
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    expect_apart_near({tubes[order[0]], tubes[order[1]], tubes[order[2]]}, most);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(LayersScenario, EachOfThreeTubesIsPutOnAsIfTheLaterOnesWereNotThereYet) {
  // The middle one stays. The others overlap it by 3 and 1 mm, so the outer one need not move more because the inner one does.
  const auto fine = [](double mean, double wave, int waves, double turn) {
    return body_of(tube(mean, wave, waves, turn, 0.0, kFine));
  };
  const double most = 0.003 + kGap + 2.0 * sagitta(0.168, 2.0 * kPi / kFine);
  expect_apart_near({fine(0.163, 0.0, 0, 5.0), fine(0.16, 0.006, 2, 0.0), fine(0.165, 0.003, 3, 0.0)}, most);
}

TEST(LayersScenario, AClothIsNotFoldedAroundTheEdgeOfASolid) {
  // It is lifted off the top, but not off the sides, where it would be pressed flat: the solid moves. Without self-contact nothing
  // else would prevent that. The edge of the solid slides along the cloth by at most a gap.
  const double overlap = 0.2 * std::tan(kPi / 60.0) - 0.003;
  expect_apart_near({box(7), tilted_cloth()}, overlap + 2.0 * kGap, false);
}

TEST(LayersScenario, TheFirstOfTwoTubesStays) {
  const SpringNetwork network = network_of({tube_body(0.16, 0.006, 2), tube_body(0.163, 0.0, 0)});
  const Simulator simulator(network, pushing_out(), {});
  const Index first = network.bodies[0].particle_count;
  EXPECT_EQ(simulator.positions().leftCols(first), network.positions.leftCols(first));
}

/// Start positions of two tubes, with all lengths of the scene multiplied by `scale`.
Points scaled_start(double scale) {
  SpringNetwork network = network_of({tube_body(0.16, 0.006, 2), tube_body(0.163, 0.0, 0, 3.0)});
  network.positions *= scale;
  for (Body& body : network.bodies) body.material.thickness *= scale;
  for (double& length : network.springs.rest_length) length *= scale;
  return Simulator(network, pushing_out(), {}).positions();
}

TEST(LayersScenario, ScaleToTheBitAndDoNotDependOnThreads) {
  const Points expected = scaled_start(1.0);
  EXPECT_EQ(scaled_start(128.0), 128.0 * expected);
  const ThreadLimit one(1);
  EXPECT_EQ(scaled_start(1.0), expected);
}

}  // namespace
}  // namespace sprung::testing
