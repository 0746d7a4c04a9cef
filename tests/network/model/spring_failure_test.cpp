// Springs that yield, springs that break, and what goes with them.
#include "network/model/spring_failure.h"

#include "network/network_builder.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Pair;
using testing::stiff;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Particles on the x axis at these places, neighbours joined by springs of rest length 1 m and 100 N/m.
SpringNetwork chain(const std::vector<double>& places, const SpringLaw& law) {
  NetworkBuilder builder;
  for (const double x : places) builder.add_particle({x, 0.0, 0.0}, 1.0);
  for (Index i = 0; i + 1 < static_cast<Index>(places.size()); ++i) {
    builder.add_spring(i, i + 1, 100.0, 1.0, 0.0, SpringKind::structural, law);
  }
  return builder.build();
}

double energy_of(const SpringNetwork& network) {
  const Springs& springs = network.springs;
  double energy = 0.0;
  for (Index s = 0; s < springs.count(); ++s) {
    const double length = (network.positions.col(springs.first[s]) - network.positions.col(springs.second[s])).norm();
    energy += 0.5 * springs.stiffness[s] * std::pow(length - springs.rest_length[s], 2);
  }
  return energy;
}

TEST(Yield, LeavesTheYieldStrainAndLessEnergy) {
  // Strains of 0.05, 0.5, -0.05 and -0.5.
  SpringNetwork network = chain({0.0, 1.05, 2.55, 3.5, 4.0}, {.yield = 0.1});
  const double before = energy_of(network);
  let_yield(network.springs, network.positions);
  EXPECT_LT(energy_of(network), before);
  EXPECT_EQ(network.springs.rest_length[0], 1.0);
  EXPECT_EQ(network.springs.rest_length[2], 1.0);
  // Lengths are differences of coordinates up to 4, and one division follows.
  EXPECT_NEAR(network.springs.rest_length[1], 1.5 / 1.1, 8 * kEpsilon);
  EXPECT_NEAR(network.springs.rest_length[3], 0.5 / 0.9, 8 * kEpsilon);
  const std::vector<double> flowed = network.springs.rest_length;
  let_yield(network.springs, network.positions);
  EXPECT_EQ(network.springs.rest_length, flowed) << "to repeat it changes nothing";
}

TEST(Yield, SpringsWithoutALengthAndSlackCablesKeepTheirRestLength) {
  SpringNetwork point = chain({0.0, 0.0}, {.yield = 0.1});
  let_yield(point.springs, point.positions);
  EXPECT_EQ(point.springs.rest_length[0], 1.0);
  SpringNetwork cable = chain({0.0, 0.5, 2.0}, {.tension_only = true, .yield = 0.1});
  let_yield(cable.springs, cable.positions);
  EXPECT_EQ(cable.springs.rest_length[0], 1.0) << "it carries nothing";
  EXPECT_NEAR(cable.springs.rest_length[1], 1.5 / 1.1, 4 * kEpsilon);
  SpringNetwork linear = chain({0.0, 5.0}, {});
  let_yield(linear.springs, linear.positions);
  EXPECT_EQ(linear.springs.rest_length[0], 1.0);
}

std::set<Pair> pairs_of(const SpringNetwork& network, SpringKind kind) {
  std::set<Pair> pairs;
  for (Index s = 0; s < network.springs.count(); ++s) {
    if (network.springs.kind[s] == kind) pairs.insert({network.springs.first[s], network.springs.second[s]});
  }
  return pairs;
}

Index spring_between(const SpringNetwork& network, Index a, Index b, SpringKind kind = SpringKind::structural) {
  for (Index s = 0; s < network.springs.count(); ++s) {
    if (network.springs.first[s] == a && network.springs.second[s] == b && network.springs.kind[s] == kind) return s;
  }
  return kNone;
}

/// Two cloths of 4 x 4 particles, of which the second is to stay as it is.
SpringNetwork two_cloths() {
  SpringMaterial material = stiff(10.0);
  material.break_strain = 0.5;
  BodyShape shape = make_cloth({.size = {3.0, 3.0}, .resolution = {4, 4}}, testing::every_kind(material));
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("torn", shape);
  builder.add_body("whole", shape);
  return builder.build();
}

void break_springs(SpringNetwork& network, const std::vector<Index>& broken) {
  tear(network, with_dependents(network.springs, broken));
}

// Numbers of the particles:
//   12 13 14 15
//    8  9 10 11
//    4  5  6  7
//    0  1  2  3
TEST(Tear, AnEdgeInsideAClothTakesTheCellsOnBothSides) {
  const SpringNetwork whole = two_cloths();
  SpringNetwork network = whole;
  break_springs(network, {spring_between(network, 5, 6)});
  const auto lost = [&](SpringKind kind) {
    std::set<Pair> pairs = pairs_of(whole, kind);
    for (const Pair& pair : pairs_of(network, kind)) EXPECT_EQ(pairs.erase(pair), 1U);
    return pairs;
  };
  EXPECT_THAT(lost(SpringKind::structural), ElementsAre(Pair(5, 6)));
  EXPECT_THAT(lost(SpringKind::shear), ElementsAre(Pair(1, 6), Pair(2, 5), Pair(5, 10), Pair(6, 9)));
  EXPECT_THAT(lost(SpringKind::bend), ElementsAre(Pair(4, 6), Pair(5, 7)));
  EXPECT_EQ(network.springs.count() + 7, whole.springs.count());

  // Cells are numbered along x, two triangles each: those below and above the edge are cells 1 and 4.
  const Body& torn = network.bodies[0];
  EXPECT_THAT(torn.surface.torn, ElementsAre(2, 3, 8, 9));
  EXPECT_EQ(torn.surface.triangles.cols(), 18 - 4);
  EXPECT_EQ(torn.surface.faces.face_count(), 18) << "faces keep their numbers";
  EXPECT_EQ(torn.surface.segments.cols(), 1) << "the border below has lost its only face";
  EXPECT_EQ(torn.surface.segments.col(0), Eigen::Vector2i(1, 2));

  const Body& other = network.bodies[1];
  EXPECT_EQ(other.spring_count, whole.bodies[1].spring_count);
  EXPECT_EQ(other.first_spring, torn.spring_count);
  EXPECT_THAT(other.surface.torn, IsEmpty());
  for (Index s = 0; s < network.springs.count(); ++s) {
    EXPECT_EQ(s >= other.first_spring, network.springs.first[s] >= other.first_particle) << "springs stay with their body";
    EXPECT_EQ(network.springs.laws[s].break_length, 1.5 * network.springs.rest_length[s]);
  }
}

TEST(Tear, ATornThreadIsGone) {
  SpringNetwork network = two_cloths();
  break_springs(network, {spring_between(network, 5, 6)});
  break_springs(network, {spring_between(network, 1, 2)});
  EXPECT_EQ(network.bodies[0].surface.segments.cols(), 0);
  EXPECT_THAT(network.bodies[0].surface.torn, ElementsAre(2, 3, 8, 9));
  break_springs(network, {spring_between(network, 13, 14)});
  EXPECT_THAT(network.bodies[0].surface.torn, ElementsAre(2, 3, 8, 9, 14, 15)) << "the rest of the faces still count as before";
}

TEST(Tear, BendSpringsAloneTakeNoFace) {
  SpringNetwork network = two_cloths();
  const Index before = network.springs.count();
  break_springs(network, {spring_between(network, 4, 6, SpringKind::bend)});
  EXPECT_EQ(network.springs.count(), before - 1);
  EXPECT_THAT(network.bodies[0].surface.torn, IsEmpty());
}

TEST(Tear, TrianglesAreNotHeldTogetherAcrossATornEdge) {
  PolygonMesh mesh;
  mesh.vertices = (Points(3, 4) << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0).finished();
  mesh.faces = to_polygons((Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished());
  mesh.lines.resize(2, 0);
  BodyShape shape = make_mesh_body(mesh, testing::every_kind(stiff(1.0)));
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("kite", shape);
  SpringNetwork network = builder.build();
  ASSERT_NE(spring_between(network, 1, 3, SpringKind::bend), kNone);
  break_springs(network, {spring_between(network, 0, 2)});
  EXPECT_EQ(spring_between(network, 1, 3, SpringKind::bend), kNone);
  EXPECT_THAT(network.bodies[0].surface.torn, ElementsAre(0, 1));
  EXPECT_EQ(network.bodies[0].surface.segments.cols(), 4) << "the sides are threads";
}

TEST(Tear, ARopeLosesTheSegmentAndTheAnglesOverIt) {
  BodyShape shape = make_rope({.points = {Vector3::Zero(), {4.0, 0.0, 0.0}}, .particles = 5, .length = {}},
                              {.structural = stiff(10.0), .bend = stiff(0.1), .bend_model = SpringMaterials::BendModel::angle});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("torn", shape);
  builder.add_body("whole", shape);
  SpringNetwork network = builder.build();
  break_springs(network, {1});  // from particle 1 to 2
  EXPECT_THAT(network.angle_bends.middle, ElementsAre(3, 6, 7, 8));
  EXPECT_EQ(network.bodies[0].angle_bend_count, 1);
  EXPECT_EQ(network.bodies[1].first_angle_bend, 1);
  EXPECT_EQ(network.bodies[1].angle_bend_count, 3);
  EXPECT_EQ(network.bodies[0].surface.segments, (Edges(2, 3) << 0, 2, 3, 1, 3, 4).finished());
  EXPECT_EQ(network.bodies[1].surface.segments.cols(), 4);
}

// Faces 0 and 1 share the side that breaks, faces 2 and 3 have a hinge at them, and faces 4 and 5 have none.
TEST(Tear, AMeshLosesTheFaceBendsOfTornTrianglesAndTheirNeighbours) {
  PolygonMesh mesh;
  mesh.vertices = (Points(3, 8) << 0, 0, 1, 1, 2, 2, 3, 3, 0, 1, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0).finished();
  mesh.faces = to_polygons((Triangles(3, 6) << 0, 1, 2, 3, 4, 5, 2, 2, 4, 4, 6, 6, 1, 3, 3, 5, 5, 7).finished());
  BodyShape shape = make_mesh_body(
      mesh, {.structural = stiff(1.0), .bend = testing::modular(1.0), .bend_model = SpringMaterials::BendModel::angle});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("torn", shape);
  builder.add_body("whole", shape);
  SpringNetwork network = builder.build();
  ASSERT_EQ(network.bodies[0].face_bend_count, 6);
  break_springs(network, {spring_between(network, 1, 2)});
  EXPECT_THAT(network.bodies[0].surface.torn, ElementsAre(0, 1));
  EXPECT_EQ(network.bodies[0].face_bend_count, 3);
  EXPECT_EQ(network.bodies[1].first_face_bend, 3);
  EXPECT_EQ(network.bodies[1].face_bend_count, 6);
  EXPECT_EQ(network.face_bends.count(), 9);
}

void expect_equal(const SpringNetwork& a, const SpringNetwork& b) {
  EXPECT_EQ(a.springs.first, b.springs.first);
  EXPECT_EQ(a.springs.second, b.springs.second);
  EXPECT_EQ(a.springs.kind, b.springs.kind);
  EXPECT_EQ(a.springs.laws, b.springs.laws);
  EXPECT_EQ(a.angle_bends.middle, b.angle_bends.middle);
  for (std::size_t k = 0; k < a.bodies.size(); ++k) {
    EXPECT_EQ(a.bodies[k].first_spring, b.bodies[k].first_spring);
    EXPECT_EQ(a.bodies[k].spring_count, b.bodies[k].spring_count);
    EXPECT_EQ(a.bodies[k].angle_bend_count, b.bodies[k].angle_bend_count);
    EXPECT_EQ(a.bodies[k].face_bend_count, b.bodies[k].face_bend_count);
    EXPECT_EQ(a.bodies[k].resolution, b.bodies[k].resolution);
    EXPECT_EQ(a.bodies[k].surface.triangles, b.bodies[k].surface.triangles);
    EXPECT_EQ(a.bodies[k].surface.segments, b.bodies[k].surface.segments);
    EXPECT_EQ(a.bodies[k].surface.torn, b.bodies[k].surface.torn);
  }
}

/// Threads come in the order in which they tore, or in that of their particles.
Edges sorted_columns(const Edges& edges) {
  std::vector<Pair> pairs;
  for (const auto& edge : edges.colwise()) pairs.emplace_back(edge[0], edge[1]);
  std::ranges::sort(pairs);
  Edges sorted(2, edges.cols());
  for (std::size_t k = 0; k < pairs.size(); ++k) sorted.col(static_cast<Index>(k)) << pairs[k].first, pairs[k].second;
  return sorted;
}

/// A network as a simulator tears it: the springs that are gone are marked in a state.
class TornNetwork {
 public:
  explicit TornNetwork(const SpringNetwork& whole) : whole_(whole), state_(initial_springs(whole.springs)) {
    state_.broken.resize(static_cast<std::size_t>(whole.springs.count()), 0);
  }

  void break_springs(const std::vector<Index>& broken) {
    const SpringNetwork present = network();
    const std::vector<char> gone = with_dependents(present.springs, broken);
    std::size_t number = 0;
    for (char& is_broken : state_.broken) {
      if (is_broken == 0) is_broken = gone[number++];
    }
  }

  [[nodiscard]] SpringNetwork network() const { return torn(whole_, state_); }
  [[nodiscard]] const SpringState& state() const { return state_; }

  static SpringNetwork torn(SpringNetwork network, const SpringState& state) {
    tear(network, state.broken);
    return network;
  }

 private:
  SpringNetwork whole_;
  SpringState state_;
};

TEST(Tear, DoesNotDependOnTheOrderInWhichSpringsBroke) {
  const SpringNetwork whole = two_cloths();
  SpringNetwork one_by_one = whole;
  TornNetwork at_once(whole);
  for (const Pair& pair : {Pair(5, 6), {21, 25}, {1, 2}, {13, 14}, {4, 5}}) {
    break_springs(one_by_one, {spring_between(one_by_one, pair.first, pair.second)});
    at_once.break_springs({spring_between(at_once.network(), pair.first, pair.second)});
    SpringNetwork now = at_once.network();
    for (SpringNetwork* network : {&one_by_one, &now}) {
      for (Body& body : network->bodies) body.surface.segments = sorted_columns(body.surface.segments);
    }
    expect_equal(now, one_by_one);
  }
}

TEST(CarriedOver, AWholeNetworkBecomesTheTornOne) {
  const SpringNetwork whole = two_cloths();
  TornNetwork torn(whole);
  torn.break_springs({spring_between(whole, 5, 6), spring_between(whole, 21, 25)});
  torn.break_springs(
      {spring_between(torn.network(), 8, 10, SpringKind::bend), spring_between(torn.network(), 24, 29, SpringKind::shear)});
  const SpringState carried = carried_over(whole, torn.state(), whole);
  EXPECT_EQ(carried, torn.state());
}

TEST(CarriedOver, OfSpringsBetweenTheSameParticlesAsManyGoAsBroke) {
  NetworkBuilder builder;
  for (int i = 0; i < 3; ++i) builder.add_particle({1.0 * i, 0.0, 0.0}, 1.0);
  for (int k = 0; k < 2; ++k) builder.add_spring(0, 1, 100.0, 1.0);
  builder.add_angle_bend(0, 1, 2, 1.0);
  const SpringNetwork network = builder.build();
  TornNetwork torn(network);
  torn.break_springs({0});
  const SpringState carried = carried_over(network, torn.state(), network);
  EXPECT_EQ(carried.broken_count(), 1);
  expect_equal(TornNetwork::torn(network, carried), torn.network());
}

TEST(CarriedOver, SpringsOfAnotherKindGoWhereTheySpanAGap) {
  const auto cloth = [](const std::optional<SpringMaterial>& shear) {
    BodyShape shape = make_cloth({.size = {3.0, 3.0}, .resolution = {4, 4}}, {.structural = stiff(10.0), .shear = shear});
    set_total_mass(shape, 1.0);
    NetworkBuilder builder;
    builder.add_body("cloth", shape);
    return builder.build();
  };
  const SpringNetwork without = cloth({});
  TornNetwork torn(without);
  torn.break_springs({spring_between(without, 5, 6)});
  const SpringNetwork with = cloth(stiff(5.0));
  const SpringNetwork network = TornNetwork::torn(with, carried_over(without, torn.state(), with));
  EXPECT_EQ(pairs_of(network, SpringKind::structural), pairs_of(torn.network(), SpringKind::structural));
  const std::set<Pair> before = pairs_of(with, SpringKind::shear);
  const std::set<Pair> after = pairs_of(network, SpringKind::shear);
  std::vector<Pair> lost;
  std::ranges::set_difference(before, after, std::back_inserter(lost));
  EXPECT_THAT(lost, ElementsAre(Pair(1, 6), Pair(2, 5), Pair(5, 10), Pair(6, 9)));
}

TEST(CarriedOver, SpringsThatYieldKeepTheirRestLengths) {
  SpringNetwork flowed = chain({0.0, 2.0, 4.0}, {.yield = 0.1});
  SpringState state = initial_springs(flowed.springs);
  EXPECT_THAT(let_yield(flowed.springs, flowed.positions), ElementsAre(0, 1));
  state.rest_lengths = flowed.springs.rest_length;
  EXPECT_EQ(carried_over(flowed, state, chain({0.0, 2.0, 4.0}, {.yield = 0.2})).rest_lengths, state.rest_lengths);
  EXPECT_THAT(carried_over(flowed, state, chain({0.0, 2.0, 4.0}, {})).rest_lengths, IsEmpty());
}

}  // namespace
}  // namespace sprung
