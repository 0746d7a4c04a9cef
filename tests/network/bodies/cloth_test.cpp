#include "network/bodies/corners.h"
#include "network/network_builder.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <limits>
#include <numeric>

namespace sprung {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Cloth, SpringCountsFollowTheResolution) {
  for (const auto& [x, y] : std::vector<std::array<Index, 2>>{{2, 2}, {2, 5}, {4, 3}, {9, 7}}) {
    const BodyShape cloth = make_cloth({{1.0, 2.0}, {x, y}}, every_kind(stiff(1)));
    EXPECT_EQ(cloth.positions.size(), static_cast<std::size_t>(x * y));
    EXPECT_EQ(count(cloth, SpringKind::structural), (x - 1) * y + x * (y - 1));
    EXPECT_EQ(count(cloth, SpringKind::shear), 2 * (x - 1) * (y - 1));
    EXPECT_EQ(count(cloth, SpringKind::bend), std::max(x - 2, 0) * y + x * std::max(y - 2, 0));
    EXPECT_EQ(cloth.surface.triangles.cols(), 2 * (x - 1) * (y - 1));
    EXPECT_EQ(cloth.surface.faces.face_count(), 2 * (x - 1) * (y - 1));
  }
}

TEST(Cloth, LiesCentredInItsPlaneAndNumbersParticlesAlongXFirst) {
  const BodyShape cloth = make_cloth({{2.0, 6.0}, {3, 4}}, {});
  EXPECT_EQ(cloth.positions[0], Vector3(-1, -3, 0));
  EXPECT_EQ(cloth.positions[1], Vector3(0, -3, 0));
  EXPECT_EQ(cloth.positions[3], Vector3(-1, -1, 0));
  EXPECT_EQ(cloth.positions[11], Vector3(1, 3, 0));
  EXPECT_EQ(cloth.measure, 12.0);
}

TEST(Cloth, RestLengthsAreTheDistances) {
  const BodyShape cloth = make_cloth({{1.0, 2.3}, {6, 5}}, every_kind(stiff(1)));
  for (Index s = 0; s < cloth.springs.count(); ++s) {
    const double distance = (cloth.positions[cloth.springs.second[s]] - cloth.positions[cloth.springs.first[s]]).norm();
    // Distances of positions near 1, each rounded by up to 2^-53.
    EXPECT_NEAR(cloth.springs.rest_length[s], distance, 1e-15);
  }
}

TEST(Cloth, EachSpringJoinsADifferentPair) {
  const BodyShape cloth = make_cloth({{1.0, 1.0}, {5, 4}}, every_kind(stiff(1)));
  std::vector<Pair> all;
  for (const SpringKind kind : {SpringKind::structural, SpringKind::shear, SpringKind::bend}) {
    for (const Pair& pair : pairs(cloth, kind)) all.push_back(pair);
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

TEST(Cloth, StructuralModulusPullsAlikeAtAnyResolution) {
  for (const auto& [x, y] : std::vector<std::array<Index, 2>>{{2, 2}, {2, 7}, {5, 3}, {40, 31}}) {
    const BodyShape cloth = make_cloth({{1.5, 0.7}, {x, y}}, {modular(250), std::nullopt, std::nullopt});
    // modulus * width * strain. The strain, computed from lengths down to 0.02, has a relative error of some 1e-14 / 1e-3.
    EXPECT_NEAR(stretching_force(cloth, 0, 0.01, 1e-3), 250 * 0.7 * 1e-3, 1e-10) << x << " x " << y;
    EXPECT_NEAR(stretching_force(cloth, 1, 0.01, 1e-3), 250 * 1.5 * 1e-3, 1e-10) << x << " x " << y;
  }
}

TEST(Cloth, ShearModulusPullsAlikeAtAnyResolution) {
  // Cells of any size have the same shape and diagonals of the same direction: the force across a cut does not depend on their
  // number.
  const auto force = [](Index cells) {
    const BodyShape cloth = make_cloth({{1.0, 2.0}, {cells + 1, 2 * cells + 1}}, {std::nullopt, modular(250), std::nullopt});
    return stretching_force(cloth, 0, 0.01, 1e-3);
  };
  // Per cell edge of length h two diagonals of length sqrt(2) h are cut; each has k = 250 h^2 / (2 h^2) = 125 and, to first order,
  // the strain 1e-3 cos^2 45: force along x = 2 * 125 * sqrt(2) h * 5e-4 * cos 45 = 0.125 h, on 2 m of edges 0.25 N.
  // The second order is 1e-3 of that.
  EXPECT_NEAR(force(2), 0.25, 0.25e-3);
  for (const Index cells : {1, 4, 16}) EXPECT_NEAR(force(cells), force(2), 1e-10) << cells << " cells";
}

TEST(Cloth, BendStiffnessIsProportionalToTheWidthOfTheRow) {
  const BodyShape cloth = make_cloth({{2.0, 2.0}, {3, 3}}, {std::nullopt, std::nullopt, modular(100)});
  // Springs of length 2 skip a particle; rows are 1 apart, border rows half as wide.
  for (Index s = 0; s < cloth.springs.count(); ++s) {
    const Vector3 ends = cloth.positions[cloth.springs.first[s]] + cloth.positions[cloth.springs.second[s]];
    const bool middle = ends == Vector3::Zero();
    EXPECT_EQ(cloth.springs.rest_length[s], 2.0);
    EXPECT_EQ(cloth.springs.stiffness[s], middle ? 50.0 : 25.0) << "from " << cloth.springs.first[s];
  }
}

TEST(Cloth, TrianglesFaceUpAndTheirAreasAreTheDragAreas) {
  const BodyShape cloth = make_cloth({{1.0, 2.0}, {4, 6}}, {});
  for (const auto& corners : cloth.surface.triangles.colwise()) {
    const Vector3& a = cloth.positions[corners[0]];
    const Vector3 normal = (cloth.positions[corners[1]] - a).cross(cloth.positions[corners[2]] - a);
    EXPECT_GT(normal.z(), 0.0);
  }
  EXPECT_NEAR(std::accumulate(cloth.drag_areas.begin(), cloth.drag_areas.end(), 0.0), 2.0, 1e-14);
  EXPECT_GT(*std::min_element(cloth.drag_areas.begin(), cloth.drag_areas.end()), 0.0);
}

TEST(Cloth, DiagonalsOfNeighbouringCellsAlternate) {
  const BodyShape cloth = make_cloth({{1.0, 1.0}, {3, 2}}, {});
  Triangles expected(3, 4);
  expected << 0, 0, 1, 2,  //
      1, 4, 2, 5,          //
      4, 3, 4, 4;
  EXPECT_EQ(cloth.surface.triangles, expected);
}

TEST(Cloth, SpringsOfANetworkMakeContiguousRuns) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  BodyShape cloth = make_cloth({{1.0, 1.0}, {8, 5}}, every_kind(stiff(1)));
  set_total_mass(cloth, 1.0);
  builder.add_body("cloth", cloth);
  const Springs& springs = builder.build().springs;
  Index runs = 1;
  for (Index s = 1; s < springs.count(); ++s) {
    const Index apart = springs.second[s] - springs.first[s];
    const Index apart_before = springs.second[s - 1] - springs.first[s - 1];
    ASSERT_TRUE(apart > apart_before || (apart == apart_before && springs.first[s] > springs.first[s - 1])) << "spring " << s;
    if (apart != apart_before || springs.first[s] != springs.first[s - 1] + 1) ++runs;
  }
  // One run per row for the families along x and the diagonals (5 + 4 + 4 + 5), and one run in total for each family along y,
  // because its rows are contiguous.
  EXPECT_EQ(runs, 5 + 4 + 4 + 5 + 1 + 1);
}

TEST(Cloth, CornersAreNamedByXThenY) {
  const ClothShape cloth{{1.0, 2.0}, {4, 3}};
  const BodyShape shape = make_cloth(cloth, {});
  EXPECT_THAT(corner_names(cloth), ElementsAre("min_min", "max_min", "min_max", "max_max"));
  EXPECT_EQ(shape.positions[*corner_particle(cloth, "min_min")], Vector3(-0.5, -1, 0));
  EXPECT_EQ(shape.positions[*corner_particle(cloth, "max_min")], Vector3(0.5, -1, 0));
  EXPECT_EQ(shape.positions[*corner_particle(cloth, "min_max")], Vector3(-0.5, 1, 0));
  EXPECT_EQ(shape.positions[*corner_particle(cloth, "max_max")], Vector3(0.5, 1, 0));
  EXPECT_EQ(corner_particle(cloth, "top_left"), std::nullopt);
}

TEST(Cloth, RejectsInvalidCloths) {
  const auto keys = [](const ClothShape& cloth) { return problem_keys([&] { return make_cloth(cloth, {}); }); };
  for (const double size : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_THAT(keys({{size, 1.0}, {2, 2}}), ElementsAre("size[0]"));
    EXPECT_THAT(keys({{1.0, size}, {2, 2}}), ElementsAre("size[1]"));
  }
  for (const Index resolution : {1, 0, -5}) {
    EXPECT_THAT(keys({{1.0, 1.0}, {resolution, 2}}), ElementsAre("resolution[0]"));
    EXPECT_THAT(keys({{1.0, 1.0}, {2, resolution}}), ElementsAre("resolution[1]"));
  }
  EXPECT_THAT(keys({{1.0, 1.0}, {2147483647, 2147483647}}), ElementsAre("resolution"));
  EXPECT_THAT(keys({{1.0, 1.0}, {65536, 65536}}), ElementsAre("resolution"));
}

TEST(Cloth, ReportsEveryProblemInOneGo) {
  const SpringMaterials materials{std::nullopt, SpringMaterial{kNan, SpringMaterial::Measure::modulus, -1.0}, std::nullopt};
  EXPECT_THAT(problem_keys([&] {
                return make_cloth({{-1.0, kNan}, {1, 0}}, materials);
              }),
              UnorderedElementsAre("size[0]", "size[1]", "resolution[0]", "resolution[1]", "springs.shear.modulus",
                                   "springs.shear.damping"));
}

}  // namespace
}  // namespace sprung
