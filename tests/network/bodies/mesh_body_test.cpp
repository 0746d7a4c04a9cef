#include "geometry/mesh/polygon_mesh.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <limits>

namespace sprung {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

PolygonMesh mesh_of(const std::vector<Vector3>& vertices, const std::vector<std::vector<Index>>& faces) {
  PolygonMesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t v = 0; v < vertices.size(); ++v) mesh.vertices.col(static_cast<Eigen::Index>(v)) = vertices[v];
  for (const std::vector<Index>& face : faces) {
    mesh.faces.vertex.insert(mesh.faces.vertex.end(), face.begin(), face.end());
    mesh.faces.corner_begin.push_back(static_cast<Index>(mesh.faces.vertex.size()));
  }
  return mesh;
}

// The grid of a cloth as quads, every other one reversed: springs do not depend on the winding of faces.
PolygonMesh quad_grid(const ClothShape& cloth) {
  const auto& [nx, ny] = cloth.resolution;
  std::vector<std::vector<Index>> faces;
  for (Index j = 0; j + 1 < ny; ++j) {
    for (Index i = 0; i + 1 < nx; ++i) {
      const Index a = i + nx * j;
      faces.push_back({a, a + 1, a + 1 + nx, a + nx});
      if (i % 2 == 1) std::reverse(faces.back().begin(), faces.back().end());
    }
  }
  return mesh_of(make_cloth(cloth, {}).positions, faces);
}

struct Spring {
  Pair ends;
  double rest_length = 0.0;
  double stiffness = 0.0;
};

std::vector<Spring> sorted_springs(const BodyShape& shape) {
  const Springs& all = shape.springs;
  std::vector<Spring> result;
  for (Index s = 0; s < all.count(); ++s) result.push_back({{all.first[s], all.second[s]}, all.rest_length[s], all.stiffness[s]});
  std::sort(result.begin(), result.end(), [](const Spring& a, const Spring& b) { return a.ends < b.ends; });
  return result;
}

double stiffness_between(const BodyShape& shape, Index a, Index b) {
  for (Index s = 0; s < shape.springs.count(); ++s) {
    if (shape.springs.first[s] == a && shape.springs.second[s] == b) return shape.springs.stiffness[s];
  }
  return -1.0;
}

constexpr SpringKind kKinds[] = {SpringKind::structural, SpringKind::shear, SpringKind::bend};

// Numbers of the vertices:
//   5 6 7 8 9
//   0 1 2 3 4   and a line from 4 to 10
TEST(MeshBody, ASpringBelongsToAPartIfItsFacesAndLinesAloneHaveIt) {
  PolygonMesh mesh = quad_grid({{4.0, 1.0}, {5, 2}});
  mesh.vertices.conservativeResize(3, 11);
  mesh.vertices.col(10) = Vector3(3.0, -0.5, 0.0);
  mesh.lines = (Edges(2, 1) << 4, 10).finished();
  const auto part = [](std::vector<Index> faces, std::vector<Index> lines, double stiffness) {
    return MeshPart{.faces = std::move(faces), .lines = std::move(lines), .materials = every_kind(stiff(stiffness))};
  };
  const BodyShape body = make_mesh_body(mesh, every_kind(stiff(1.0)), {part({0, 1}, {}, 2.0), part({2}, {0}, 3.0)});
  EXPECT_EQ(stiffness_between(body, 0, 1), 2.0);
  EXPECT_EQ(stiffness_between(body, 1, 5), 2.0) << "a diagonal";
  EXPECT_EQ(stiffness_between(body, 0, 2), 2.0) << "a bend spring in the part";
  EXPECT_EQ(stiffness_between(body, 2, 7), 3.0) << "on the border of both: the last part";
  EXPECT_EQ(stiffness_between(body, 3, 8), 3.0);
  EXPECT_EQ(stiffness_between(body, 1, 3), 1.0) << "a bend spring over the border of the parts";
  EXPECT_EQ(stiffness_between(body, 3, 4), 1.0);
  EXPECT_EQ(stiffness_between(body, 4, 10), 3.0) << "a line";

  mesh.lines.resize(2, 0);
  MeshPart shear_alone{.faces = {0}, .materials = {.shear = modular(7.0)}};
  const BodyShape other = make_mesh_body(mesh, every_kind(modular(1.0)), {shear_alone});
  const BodyShape plain = make_mesh_body(mesh, every_kind(modular(1.0)));
  EXPECT_EQ(stiffness_between(other, 0, 1), stiffness_between(plain, 0, 1));
  EXPECT_DOUBLE_EQ(stiffness_between(other, 0, 6), 7.0 * stiffness_between(plain, 0, 6)) << "the modulus of the part";
}

// Stripes: the faces 0 and 2 of a part have the ends of the edges between them too.
TEST(MeshBody, ASpringBetweenTwoStripesOfAPartIsNotOfThePart) {
  const BodyShape body = make_mesh_body(quad_grid({{3.0, 1.0}, {4, 2}}), every_kind(stiff(1.0)),
                                        {{.faces = {0, 2}, .materials = every_kind(stiff(2.0))}});
  EXPECT_EQ(stiffness_between(body, 1, 2), 1.0);
  EXPECT_EQ(stiffness_between(body, 1, 5), 2.0);
}

TEST(MeshBody, AGridOfQuadsHasTheSpringsOfACloth) {
  const ClothShape shape{{1.0, 1.8}, {6, 5}};
  const BodyShape cloth = make_cloth(shape, every_kind(modular(70)));
  const BodyShape body = make_mesh_body(quad_grid(shape), every_kind(modular(70)));
  for (const SpringKind kind : kKinds) EXPECT_EQ(pairs(body, kind), pairs(cloth, kind));
  EXPECT_NEAR(body.measure, cloth.measure, 1e-14);

  const auto expected = sorted_springs(cloth);
  const auto actual = sorted_springs(body);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t s = 0; s < actual.size(); ++s) {
    // Sums of a few areas and distances, each rounded a few times: some 1e-15 relative.
    EXPECT_NEAR(actual[s].rest_length, expected[s].rest_length, 1e-14);
    EXPECT_NEAR(actual[s].stiffness, expected[s].stiffness, 1e-12)
        << "from " << actual[s].ends.first << " to " << actual[s].ends.second;
  }
}

TEST(MeshBody, TwoTrianglesBendAcrossTheirSharedEdge) {
  const PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const BodyShape body = make_mesh_body(mesh, every_kind(stiff(1)));
  EXPECT_THAT(pairs(body, SpringKind::structural), ElementsAre(Pair{0, 1}, Pair{0, 2}, Pair{0, 3}, Pair{1, 2}, Pair{2, 3}));
  EXPECT_THAT(pairs(body, SpringKind::shear), ElementsAre());
  EXPECT_THAT(pairs(body, SpringKind::bend), ElementsAre(Pair{1, 3}));
}

TEST(MeshBody, APairIsJoinedOnceAndStructuralSpringsTakePrecedence) {
  // A tetrahedron: an edge joins the opposite corners of any two faces already.
  const PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  const BodyShape body = make_mesh_body(mesh, every_kind(stiff(1)));
  EXPECT_EQ(count(body, SpringKind::structural), 6);
  EXPECT_EQ(body.springs.count(), 6);
}

TEST(MeshBody, ShearSpringsLieAlongTheDiagonalsThatSkipACorner) {
  std::vector<Vector3> corners;
  for (int i = 0; i < 6; ++i) corners.emplace_back(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3), 0.0);
  const BodyShape body = make_mesh_body(mesh_of(corners, {{0, 1, 2, 3, 4, 5}}), every_kind(stiff(1)));
  EXPECT_EQ(count(body, SpringKind::structural), 6);
  EXPECT_THAT(pairs(body, SpringKind::shear), ElementsAre(Pair{0, 2}, Pair{0, 4}, Pair{1, 3}, Pair{1, 5}, Pair{2, 4}, Pair{3, 5}));
}

TEST(MeshBody, AnEvenStretchStoresTheSameEnergyInAnyMesh) {
  // Under a uniform strain in both directions, the structural springs of any sheet store the energy modulus * strain^2 * area: the
  // sum of 1/2 (modulus area_s / d^2) (strain d)^2, where the areas of the springs add up to twice that of the sheet.
  const std::vector<Vector3> vertices{{0, 0, 0}, {2, 0, 0}, {2.5, 1, 0}, {2, 2.2, 0}, {0, 2, 0}, {0.9, 1.1, 0}};
  const PolygonMesh triangles = mesh_of(vertices, {{0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 0, 5}});
  const PolygonMesh mixed = mesh_of(vertices, {{0, 1, 5}, {1, 2, 3, 5}, {3, 4, 0, 5}});
  const PolygonMesh pentagon = mesh_of({vertices.begin(), vertices.begin() + 5}, {{0, 1, 2, 3, 4}});
  for (const PolygonMesh& mesh : {triangles, mixed, pentagon}) {
    const BodyShape body = make_mesh_body(mesh, {modular(40), std::nullopt, std::nullopt});
    double energy = 0.0;
    for (Index s = 0; s < body.springs.count(); ++s) {
      energy += 0.5 * body.springs.stiffness[s] * std::pow(0.01 * body.springs.rest_length[s], 2);
    }
    EXPECT_NEAR(energy, 40 * 1e-4 * body.measure, 1e-15);
  }
}

TEST(MeshBody, KeepsFacesGroupsAndTextureCoordinates) {
  PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}}, {{0, 1, 2, 3}, {1, 4, 2}});
  mesh.faces.texcoord = {0, 1, 2, 3, 1, kNone, 2};
  mesh.faces.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.faces.groups = {"flag", "tip"};
  mesh.faces.group_begin = {0, 1};
  const Surface surface = make_mesh_body(mesh, {}).surface;
  EXPECT_EQ(surface.faces.vertex, mesh.faces.vertex);
  EXPECT_EQ(surface.faces.corner_begin, mesh.faces.corner_begin);
  EXPECT_EQ(surface.faces.texcoord, mesh.faces.texcoord);
  EXPECT_EQ(surface.faces.texcoords, mesh.faces.texcoords);
  EXPECT_EQ(surface.faces.groups, mesh.faces.groups);
  EXPECT_EQ(surface.faces.group_begin, mesh.faces.group_begin);
  EXPECT_EQ(surface.triangles, triangulate(mesh.faces));
}

TEST(MeshBody, LinesBecomeSpringsAndSegments) {
  PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 2}}, {{0, 1, 2}});
  mesh.lines.resize(2, 2);
  mesh.lines << 3, 0,  //
      0, 1;
  const BodyShape body = make_mesh_body(mesh, {stiff(5), std::nullopt, std::nullopt});
  EXPECT_THAT(pairs(body, SpringKind::structural), ElementsAre(Pair{0, 1}, Pair{0, 2}, Pair{0, 3}, Pair{1, 2}));
  ASSERT_EQ(body.surface.segments.cols(), 1) << "a line along an edge of a triangle is not a segment";
  EXPECT_EQ(body.surface.segments.col(0), (Eigen::Matrix<Index, 2, 1>(0, 3)));
  EXPECT_EQ(body.measures[3], 0.0) << "a line of a mesh with faces has no area";
  EXPECT_EQ(body.drag_areas[3], 1.0) << "half of the 2 m of the line";
  EXPECT_NEAR(body.drag_areas[0], 0.5 / 3 + 1.0, 1e-15);
  EXPECT_NEAR(body.measure, 0.5, 1e-15) << "the area of the faces";
  EXPECT_THAT(problem_keys([&] {
                return make_mesh_body(mesh, {modular(5), std::nullopt, std::nullopt});
              }),
              ElementsAre("springs.structural.modulus"));

  mesh.faces = {};
  EXPECT_EQ(make_mesh_body(mesh, {}).measure, 3.0) << "without faces it is the length of the lines";
}

TEST(MeshBody, RejectsInvalidMeshes) {
  const auto keys = [](const PolygonMesh& mesh) { return problem_keys([&] { return make_mesh_body(mesh, {}); }); };
  const std::vector<Vector3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  EXPECT_THAT(keys({}), ElementsAre("vertices"));
  EXPECT_THAT(keys(mesh_of(corners, {{0, 1, 3}})), ElementsAre("faces[0]"));
  EXPECT_THAT(keys(mesh_of(corners, {{0, 1, 2}, {0, -1, 2}})), ElementsAre("faces[1]"));
  EXPECT_THAT(keys(mesh_of(corners, {{0, 1}})), ElementsAre("faces[0]"));
  EXPECT_THAT(keys(mesh_of(corners, {{0, 1, 0}})), ElementsAre("faces[0]"));
  EXPECT_THAT(keys(mesh_of({{0, 0, 0}, {1, std::numeric_limits<double>::infinity(), 0}, {1, 1, 0}}, {{0, 1, 2}})),
              ElementsAre("vertices[1]"));

  PolygonMesh torn = mesh_of(corners, {{0, 1, 2}});
  torn.faces.corner_begin = {0, 4};
  EXPECT_THAT(keys(torn), ElementsAre("faces.corner_begin"));

  PolygonMesh lines = mesh_of(corners, {});
  lines.lines.resize(2, 2);
  lines.lines << 0, 1,  //
      9, 1;
  EXPECT_THAT(keys(lines), UnorderedElementsAre("lines[0]", "lines[1]"));
}

}  // namespace
}  // namespace sprung
