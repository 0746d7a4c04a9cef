#include "network/bodies/body_shape.h"
#include "network/network_builder.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace sprung {
namespace {

SpringMaterials stiff(double rigidity) {
  return {.structural = SpringMaterial{.value = 1.0},
          .bend = SpringMaterial{.value = rigidity, .measure = SpringMaterial::Measure::modulus, .damping_time = 0.5},
          .bend_model = SpringMaterials::BendModel::angle};
}

/// Squares of 1 m with parallel diagonals, from the origin.
PolygonMesh grid(Index squares) {
  PolygonMesh mesh;
  mesh.vertices.resize(3, (squares + 1) * (squares + 1));
  const auto number = [&](Index i, Index j) { return j * (squares + 1) + i; };
  for (Index j = 0; j <= squares; ++j) {
    for (Index i = 0; i <= squares; ++i) mesh.vertices.col(number(i, j)) = Vector3(i, j, 0.0);
  }
  std::vector<std::array<Index, 3>> triangles;
  for (Index j = 0; j < squares; ++j) {
    for (Index i = 0; i < squares; ++i) {
      triangles.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      triangles.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  for (const auto& corners : triangles) {
    mesh.faces.vertex.insert(mesh.faces.vertex.end(), corners.begin(), corners.end());
    mesh.faces.corner_begin.push_back(static_cast<Index>(mesh.faces.vertex.size()));
  }
  return mesh;
}

/// F phi of an element with small heights z [m] of the body's particles, divided by the square root of its area.
Vector3 curvature(const BodyShape& shape, Index element, const std::vector<double>& z) {
  const BendStencil stencil = stencil_of(shape.face_bends, shape.hinges, element);
  const auto rows = weights_of(shape.face_bends, shape.hinges, element);
  Vector3 result = Vector3::Zero();
  for (Index row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 6; ++i) result[row] += rows[row][i] * z[stencil.particles[i]];
  }
  return result / std::sqrt(0.5);
}

std::vector<double> heights(const BodyShape& shape, const std::function<double(const Vector3&)>& z) {
  std::vector<double> result;
  for (const Vector3& position : shape.positions) result.push_back(z(position));
  return result;
}

bool has_all_hinges(const BodyShape& shape, Index element) {
  return std::ranges::find(shape.face_bends.hinges[element], kNone) == shape.face_bends.hinges[element].end();
}

TEST(TriangleBends, EachTriangleHasAnElementWithTheRigidityOfTheMaterial) {
  const BodyShape shape = make_mesh_body(grid(3), stiff(2.0));
  EXPECT_EQ(shape.face_bends.count(), 18);
  EXPECT_EQ(shape.hinges.count(), 21);  // 3 per square, without 6 at each of the borders below and left
  EXPECT_THAT(shape.face_bends.stiffness, ::testing::Each(2.0));
  EXPECT_THAT(shape.face_bends.damping, ::testing::Each(1.0));
  EXPECT_THAT(shape.hinges.rest_angle, ::testing::Each(0.0));
  EXPECT_THAT(shape.angle_bends.middle, ::testing::IsEmpty());
}

TEST(TriangleBends, APlaneHasNoCurvatureHoweverItIsTilted) {
  const BodyShape shape = make_mesh_body(grid(3), stiff(1.0));
  const std::vector<double> z = heights(shape, [](const Vector3& at) { return 0.3 * at.x() - 0.7 * at.y() + 2.0; });
  for (Index f = 0; f < shape.face_bends.count(); ++f) EXPECT_LT(curvature(shape, f, z).norm(), 1e-13);
}

TEST(TriangleBends, TheCurvatureOfAGridIsExact) {
  const BodyShape shape = make_mesh_body(grid(4), stiff(1.0));
  const std::vector<double> z = heights(
      shape, [](const Vector3& at) { return 0.5 * (2.0 * at.x() * at.x() - 3.0 * at.y() * at.y()) + 5.0 * at.x() * at.y(); });
  int whole = 0;
  for (Index f = 0; f < shape.face_bends.count(); ++f) {
    if (!has_all_hinges(shape, f)) continue;
    ++whole;
    // In the frame of each triangle, whose first side lies along x in one half of them, and along the diagonal in the other.
    const Vector3 found = curvature(shape, f, z);
    const Vector3 expected =
        f % 2 == 0 ? Vector3(2.0, -3.0, 5.0 * std::numbers::sqrt2) : Vector3(4.5, -5.5, -2.5 * std::numbers::sqrt2);
    EXPECT_LT((found - expected).norm(), 1e-12) << f;
  }
  EXPECT_GT(whole, 10);
}

TEST(TriangleBends, TwoTrianglesTurnedOverBendAsTwoThatAreNot) {
  PolygonMesh mesh = grid(1);
  const BodyShape shape = make_mesh_body(mesh, stiff(1.0));
  std::swap(mesh.faces.vertex[4], mesh.faces.vertex[5]);
  const BodyShape turned = make_mesh_body(mesh, stiff(1.0));
  const std::vector<double> z{0.0, 1.0, 1.0, 0.0};
  ASSERT_EQ(turned.face_bends.count(), 2);
  for (Index f = 0; f < 2; ++f) EXPECT_NEAR(curvature(shape, f, z).norm(), curvature(turned, f, z).norm(), 1e-13);
}

TEST(TriangleBends, ACornerOfACubeRestsAtItsRightAngle) {
  PolygonMesh mesh;
  mesh.vertices = (Points(3, 4) << 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1).finished();
  mesh.faces.vertex = {0, 1, 2, 1, 0, 3};  // the edge along y, faces in the planes z = 0 and x = 0
  mesh.faces.corner_begin = {0, 3, 6};
  const BodyShape shape = make_mesh_body(mesh, stiff(1.0));
  ASSERT_EQ(shape.hinges.count(), 1);
  EXPECT_NEAR(std::abs(shape.hinges.rest_angle[0]), std::numbers::pi / 2.0, 1e-15);
}

TEST(TriangleBends, EdgesOfThreeTrianglesAndThinTrianglesTransferNoMoment) {
  PolygonMesh fan;
  fan.vertices = (Points(3, 5) << 0, 1, 0, 0, 1, 0, 0, 1, -1, 0, 0, 0, 0, 0, 1).finished();
  fan.faces.vertex = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  fan.faces.corner_begin = {0, 3, 6, 9};
  EXPECT_EQ(make_mesh_body(fan, stiff(1.0)).face_bends.count(), 0);

  PolygonMesh thin;
  thin.vertices = (Points(3, 4) << 0, 1, 0.5, 0.5, 0, 0, 1e-9, -1, 0, 0, 0, 0).finished();
  thin.faces.vertex = {0, 1, 2, 1, 0, 3};
  thin.faces.corner_begin = {0, 3, 6};
  EXPECT_EQ(make_mesh_body(thin, stiff(1.0)).face_bends.count(), 0);
}

TEST(TriangleBends, PartsHaveRigiditiesOfTheirOwn) {
  const MeshPart stiffer{.faces = {0, 1}, .lines = {}, .materials = stiff(7.0)};
  const BodyShape shape = make_mesh_body(grid(2), stiff(2.0), {stiffer});
  EXPECT_THAT(shape.face_bends.stiffness, ::testing::ElementsAre(7, 7, 2, 2, 2, 2, 2, 2));
}

TEST(TriangleBends, NeedAModulus) {
  SpringMaterials materials = stiff(1.0);
  materials.bend->measure = SpringMaterial::Measure::stiffness;
  EXPECT_THAT(testing::problem_keys([&] { return make_mesh_body(grid(1), materials); }),
              ::testing::ElementsAre("springs.bend.stiffness"));
}

TEST(TriangleBends, AreCheckedInShapesThatAProgramChanged) {
  const auto refused = [](const std::function<void(BodyShape&)>& change) {
    BodyShape shape = make_mesh_body(grid(2), stiff(1.0));
    set_total_mass(shape, 1.0);
    change(shape);
    NetworkBuilder builder;
    builder.add_body("sheet", shape);
    return testing::problem_keys([&] { return builder.build(); });
  };
  EXPECT_THAT(refused([](BodyShape&) {}), ::testing::IsEmpty());
  EXPECT_THAT(refused([](BodyShape& shape) { shape.hinges.particles[3][2] = 99; }),
              ::testing::ElementsAre("bodies.sheet.hinges[3]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.hinges.particles[3][0] = shape.hinges.particles[3][1]; }),
              ::testing::ElementsAre("bodies.sheet.hinges[3]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.hinges.rest_area[1][0] = 0.0; }),
              ::testing::ElementsAre("bodies.sheet.hinges.rest_area[1]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.face_bends.hinges[2].fill(kNone); }),
              ::testing::ElementsAre("bodies.sheet.face_bends.hinges[2]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.face_bends.hinges[2][1] = 99; }),
              ::testing::ElementsAre("bodies.sheet.face_bends.hinges[2]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.face_bends.hinges[0].fill(0); }),
              ::testing::ElementsAre("bodies.sheet.hinges[0]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.face_bends.stiffness[0] = -1.0; }),
              ::testing::ElementsAre("bodies.sheet.face_bends.stiffness[0]"));
  EXPECT_THAT(refused([](BodyShape& shape) { shape.face_bends.damping.pop_back(); }), ::testing::ElementsAre("bodies.sheet"));
}

TEST(TriangleBends, AMeshOfLinesHasNone) {
  PolygonMesh lines;
  lines.vertices = (Points(3, 3) << 0, 1, 2, 0, 0, 0, 0, 0, 0).finished();
  lines.lines = (Edges(2, 2) << 0, 1, 1, 2).finished();
  EXPECT_EQ(make_mesh_body(lines, stiff(1.0)).face_bends.count(), 0);
}

}  // namespace
}  // namespace sprung
