#include "geometry/mesh/topology.h"
#include "geometry/mesh/triangle_mesh.h"
#include "network/bodies/corners.h"
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

TEST(Solid, SpringCountsFollowTheResolution) {
  for (const auto& [x, y, z] : std::vector<std::array<Index, 3>>{{2, 2, 2}, {2, 3, 4}, {5, 4, 3}, {6, 6, 6}}) {
    const BodyShape solid = make_solid({Vector3(1, 2, 3), {x, y, z}}, every_kind(stiff(1)));
    const Index cx = x - 1, cy = y - 1, cz = z - 1;
    EXPECT_EQ(solid.positions.size(), static_cast<std::size_t>(x * y * z));
    EXPECT_EQ(count(solid, SpringKind::structural), cx * y * z + x * cy * z + x * y * cz);
    EXPECT_EQ(count(solid, SpringKind::shear), 2 * (cx * cy * z + cx * y * cz + x * cy * cz) + 4 * cx * cy * cz);
    EXPECT_EQ(count(solid, SpringKind::bend), (x - 2) * y * z + x * (y - 2) * z + x * y * (z - 2));
    EXPECT_EQ(solid.surface.triangles.cols(), 4 * (cx * cy + cy * cz + cz * cx));
  }
}

TEST(Solid, ParticlesAreNumberedXThenYThenZ) {
  const BodyShape solid = make_solid({Vector3(2, 4, 6), {3, 3, 4}}, {});
  EXPECT_EQ(solid.positions[0], Vector3(-1, -2, -3));
  EXPECT_EQ(solid.positions[1], Vector3(0, -2, -3));
  EXPECT_EQ(solid.positions[3], Vector3(-1, 0, -3));
  EXPECT_EQ(solid.positions[9], Vector3(-1, -2, -1));
  EXPECT_EQ(solid.positions[35], Vector3(1, 2, 3));
  EXPECT_EQ(solid.measure, 48.0);
}

TEST(Solid, RestLengthsAreTheDistancesAndPairsDiffer) {
  const BodyShape solid = make_solid({Vector3(1, 2, 1.5), {4, 3, 5}}, every_kind(stiff(1)));
  std::vector<Pair> all;
  for (Index s = 0; s < solid.springs.count(); ++s) {
    const Index a = solid.springs.first[s];
    const Index b = solid.springs.second[s];
    all.emplace_back(a, b);
    // Distances of positions near 1, each rounded by up to 2^-53.
    EXPECT_NEAR(solid.springs.rest_length[s], (solid.positions[b] - solid.positions[a]).norm(), 2e-15);
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

TEST(Solid, StructuralModulusPullsAlikeAtAnyResolution) {
  const Vector3 size(1.5, 0.7, 1.1);
  for (const auto& resolution : std::vector<std::array<Index, 3>>{{2, 2, 2}, {2, 5, 3}, {9, 8, 7}}) {
    const BodyShape solid = make_solid({size, resolution}, {modular(1e4), std::nullopt, std::nullopt});
    for (int axis = 0; axis < 3; ++axis) {
      const double expected = 1e4 * size.prod() / size[axis] * 1e-3;
      // The strain, computed from lengths near 0.1, has a relative error of some 1e-15 / 1e-4.
      EXPECT_NEAR(stretching_force(solid, axis, 0.01, 1e-3), expected, 1e-10 * expected) << "axis " << axis;
    }
  }
}

TEST(Solid, ShearModulusPullsAlikeAtAnyResolution) {
  const auto force = [](Index cells) {
    const BodyShape solid =
        make_solid({Vector3(1, 1, 2), {cells + 1, cells + 1, 2 * cells + 1}}, {std::nullopt, modular(1e4), std::nullopt});
    return stretching_force(solid, 2, 0.01, 1e-3);
  };
  for (const Index cells : {1, 2, 8}) EXPECT_NEAR(force(cells), force(4), 1e-10 * force(4)) << cells << " cells";
}

TEST(Solid, SurfaceIsClosedFacesOutwardAndEnclosesTheVolume) {
  const BodyShape solid = make_solid({Vector3(1, 2, 3), {3, 4, 2}}, {});
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(solid.positions.size()));
  for (std::size_t i = 0; i < solid.positions.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = solid.positions[i];
  mesh.triangles = solid.surface.triangles;
  EXPECT_TRUE(is_closed(mesh.triangles));
  EXPECT_NEAR(signed_volume(mesh), 6.0, 1e-14);
}

TEST(Solid, OnlyParticlesOfTheSurfaceHaveADragArea) {
  const BodyShape solid = make_solid({Vector3(1, 2, 3), {3, 3, 3}}, {});
  EXPECT_EQ(solid.drag_areas[13], 0.0) << "the particle in the middle";
  EXPECT_EQ(std::count(solid.drag_areas.begin(), solid.drag_areas.end(), 0.0), 1);
  // The areas of the faces of a 1 x 2 x 3 box.
  EXPECT_NEAR(std::accumulate(solid.drag_areas.begin(), solid.drag_areas.end(), 0.0), 22.0, 1e-13);
}

TEST(Solid, CornersAreNamedByXThenYThenZ) {
  const SolidShape solid{Vector3(2, 4, 6), {3, 4, 5}};
  const BodyShape shape = make_solid(solid, {});
  EXPECT_EQ(corner_names(solid).size(), 8U);
  EXPECT_EQ(shape.positions[*corner_particle(solid, "min_min_min")], Vector3(-1, -2, -3));
  EXPECT_EQ(shape.positions[*corner_particle(solid, "max_min_min")], Vector3(1, -2, -3));
  EXPECT_EQ(shape.positions[*corner_particle(solid, "min_max_min")], Vector3(-1, 2, -3));
  EXPECT_EQ(shape.positions[*corner_particle(solid, "min_min_max")], Vector3(-1, -2, 3));
  EXPECT_EQ(shape.positions[*corner_particle(solid, "max_max_max")], Vector3(1, 2, 3));
  EXPECT_EQ(corner_particle(solid, "min_min"), std::nullopt);
}

TEST(Solid, RejectsInvalidSolids) {
  const auto keys = [](const SolidShape& solid) { return problem_keys([&] { return make_solid(solid, {}); }); };
  EXPECT_THAT(keys({Vector3(0, -1, kNan), {1, 0, -3}}),
              UnorderedElementsAre("size[0]", "size[1]", "size[2]", "resolution[0]", "resolution[1]", "resolution[2]"));
  EXPECT_THAT(keys({Vector3::Ones(), {2000, 2000, 2000}}), ElementsAre("resolution"));
  EXPECT_THAT(problem_keys([] {
                return make_solid({}, {std::nullopt, std::nullopt, stiff(-1)});
              }),
              ElementsAre("springs.bend.stiffness"));
}

TEST(Place, TakesARotationAndATranslationAlone) {
  BodyShape shape = make_solid({}, {});
  const std::vector<Vector3> before = shape.positions;
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() *= 2.0;
  EXPECT_THROW(place(shape, pose), InputError);
  pose.linear() = Vector3(1.0, 1.0, -1.0).asDiagonal();
  EXPECT_THROW(place(shape, pose), InputError);
  EXPECT_EQ(shape.positions, before);
  pose.linear() = rotation_from_degrees({10.0, 20.0, 30.0});
  place(shape, pose);
  EXPECT_EQ(shape.positions.front(), pose * before.front());
}

}  // namespace
}  // namespace sprung
