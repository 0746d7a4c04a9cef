#include "geometry/mesh/polygon_mesh.h"

#include "base/error.h"
#include "geometry/fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ReadObj : public test::FileTest {
 protected:
  [[nodiscard]] PolygonMesh read(const std::string& text) const { return read_obj(write("mesh.obj", text)); }

  [[nodiscard]] std::string error_of(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("mesh.obj"));
      return error.what();
    }
    return "accepted";
  }
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ReadObj, KeepsOrderPolygonsTexcoordsAndGroups) {
  const PolygonMesh mesh = read("# a square and a triangle\no first thing\n" + kSquare +
                                "vt 0 0\nvt 1 0.5\nvn 0 0 1\nf 3/1/1 4/2/1 1//1 2\ng a b\nusemtl red\nf 1/2 2 3\n");
  EXPECT_EQ(mesh.vertices, test::make_points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_THAT(mesh.faces.corner_begin, ElementsAre(0, 4, 7));
  EXPECT_THAT(mesh.faces.vertex, ElementsAre(2, 3, 0, 1, 0, 1, 2));
  EXPECT_THAT(mesh.faces.texcoord, ElementsAre(0, 1, kNone, kNone, 1, kNone, kNone));
  EXPECT_THAT(mesh.faces.texcoords, ElementsAre(ElementsAre(0, 0), ElementsAre(1, 0.5)));
  EXPECT_THAT(mesh.faces.groups, ElementsAre("first thing", "a b"));
  EXPECT_THAT(mesh.faces.group_begin, ElementsAre(0, 1));
}

TEST_F(ReadObj, ResolvesNegativeNumbersFromTheFace) {
  const PolygonMesh mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nl -4 -1\n");
  EXPECT_THAT(mesh.faces.vertex, ElementsAre(0, 1, 2));
  EXPECT_EQ(mesh.lines.col(0), Eigen::Vector2i(0, 3));
}

TEST_F(ReadObj, CutsPolylinesIntoEdges) {
  const PolygonMesh mesh = read(kSquare + "g rope\nl 1 2 3\ng other\nusemtl x\nl 4/1 1/1\nusemtl y\n");
  Edges expected(2, 3);
  expected << 0, 1, 3, 1, 2, 0;
  EXPECT_EQ(mesh.lines, expected);
  EXPECT_EQ(mesh.faces.face_count(), 0);
}

TEST_F(ReadObj, ReadsTheNearestDouble) {
  const PolygonMesh mesh = read("v 0.1234567890123456789 1e-320 +3.3333333333333333333e5\n");
  EXPECT_EQ(mesh.vertices.col(0), Vector3(0.1234567890123456789, 1e-320, 3.3333333333333333333e5));
}

TEST_F(ReadObj, AcceptsAnyLineEndCommentAndContinuation) {
  const PolygonMesh mesh = read("v 0 0 0 # origin\r\nv 1 0 \\\r\n 0\r\nv 0 1 0\rf 1 2 \\\n 3\n");
  EXPECT_EQ(mesh.vertices, test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(mesh.faces.vertex, ElementsAre(0, 1, 2));
}

TEST_F(ReadObj, KeepsPolygonsOfManyCorners) {
  std::string text;
  std::string face = "f";
  for (int i = 1; i <= 300; ++i) {
    const std::string number = std::to_string(i);
    text.append("v 0 ").append(number).append(" 0\n");
    face.append(" ").append(number);
  }
  EXPECT_THAT(read(text + face + "\n").faces.corner_begin, ElementsAre(0, 300));
}

TEST_F(ReadObj, RefusesBadNumbersNamingTheLine) {
  for (const std::string bad : {"nan", "inf", "1e999", "abc", "1.0x", "--1", "+-1"}) {
    EXPECT_THAT(error_of("v 0 0 0\nv 1 " + bad + " 0\n"), HasSubstr("line 2 = " + bad + ": must be a finite number")) << bad;
  }
  EXPECT_THAT(error_of("v 0 0 0 \\\n\n\nv 1 2\n"), HasSubstr("line 4: a vertex must have three coordinates"));
  EXPECT_THAT(error_of(kSquare + "vt nan 0\n"), HasSubstr("line 5 = nan"));
  EXPECT_THAT(error_of(kSquare + "vt\n"), HasSubstr("line 5"));
}

TEST_F(ReadObj, RefusesIndicesOutOfRangeNamingTheFace) {
  EXPECT_THAT(error_of(kSquare + "f 1 2 3\nf 1 2 5\n"), HasSubstr("face 2 = 5: must refer to one of the 4 vertices"));
  EXPECT_THAT(error_of(kSquare + "f 1 2 -5\n"), HasSubstr("face 1 = -5"));
  EXPECT_THAT(error_of(kSquare + "f 1/1 2/1 3/1\n"), HasSubstr("must refer to one of the 0 texture coordinates"));
  EXPECT_THAT(error_of(kSquare + "l 1 9\n"), HasSubstr("line 5 = 9"));
  EXPECT_THAT(error_of(kSquare + "l 1 -9\n"), HasSubstr("line 5 = -9"));
  for (const std::string bad : {"0", "4294967297", "99999999999999999999", "-99999999999", "x", "1/x", "/1", "1/0"}) {
    EXPECT_THAT(error_of(kSquare + "f 1 2 " + bad + "\n"), HasSubstr("line 5 = " + bad)) << bad;
  }
}

TEST_F(ReadObj, RefusesFacesThatAreNotPolygons) {
  EXPECT_THAT(error_of(kSquare + "f 1 2\n"), HasSubstr("line 5: a face must have at least three corners"));
  EXPECT_THAT(error_of(kSquare + "f\n"), HasSubstr("line 5"));
  EXPECT_THAT(error_of(kSquare + "f 1 2 3\nf 1 2 3 2\n"), HasSubstr("face 2 = 2: a face must not use a vertex twice"));
  EXPECT_THAT(error_of(kSquare + "l 1\n"), HasSubstr("line 5"));
}

TEST_F(ReadObj, ReportsEveryProblemAndCountsTheRest) {
  const std::string two = error_of("v 0 0 nan\nv 1\n");
  EXPECT_THAT(two, HasSubstr("line 1"));
  EXPECT_THAT(two, HasSubstr("line 2"));
  std::string many;
  for (int i = 0; i < 100; ++i) many += "v x 0 0\n";
  EXPECT_THAT(error_of(many), HasSubstr("80 more problems"));
}

TEST_F(ReadObj, RefusesFilesWithoutAMesh) {
  EXPECT_THAT(error_of(""), HasSubstr("is empty"));
  EXPECT_THAT(error_of("# nothing\n"), HasSubstr("has no vertices"));
  EXPECT_THAT(error_of(std::string("\0\1\2\377\r\n\\", 7)), HasSubstr("has no vertices"));
  EXPECT_THROW((void)read_obj(folder() / "missing.obj"), InputError);
  EXPECT_THROW((void)read_obj(folder()), InputError);
}

TEST_F(ReadObj, RestoresAWrittenMeshBitForBit) {
  std::mt19937_64 random(3);
  PolygonMesh mesh;
  mesh.vertices.resize(3, 200);
  for (double& value : mesh.vertices.reshaped()) {
    do value = std::bit_cast<double>(random());
    while (!std::isfinite(value));
  }
  mesh.faces.corner_begin = {0, 3, 7, 12};
  mesh.faces.vertex = {5, 9, 199, 0, 1, 2, 3, 10, 20, 30, 40, 50};
  mesh.faces.texcoord = {0, 1, 1, kNone, kNone, kNone, kNone, 1, 0, 1, 0, 1};
  mesh.faces.texcoords = {{0.1, 1.0 / 3.0}, {-0.0, 1e-310}};
  mesh.faces.groups = {"upper part", "lower"};
  mesh.faces.group_begin = {1, 2};
  mesh.lines.resize(2, 4);
  mesh.lines << 0, 1, 5, 7, 1, 2, 6, 5;
  const PolygonMesh back = read(obj_text(mesh.vertices, mesh.faces, mesh.lines));
  ASSERT_EQ(back.vertices.cols(), mesh.vertices.cols());
  const auto same_bits = [](double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); };
  EXPECT_TRUE(std::equal(mesh.vertices.data(), mesh.vertices.data() + mesh.vertices.size(), back.vertices.data(), same_bits));
  EXPECT_EQ(back.faces.corner_begin, mesh.faces.corner_begin);
  EXPECT_EQ(back.faces.vertex, mesh.faces.vertex);
  EXPECT_EQ(back.faces.texcoord, mesh.faces.texcoord);
  EXPECT_EQ(back.faces.texcoords, mesh.faces.texcoords);
  EXPECT_EQ(back.faces.groups, mesh.faces.groups);
  EXPECT_EQ(back.faces.group_begin, mesh.faces.group_begin);
  EXPECT_EQ(back.lines, mesh.lines);
}

TEST(ObjText, WritesALineForEachEdge) {
  Edges lines(2, 3);
  lines << 0, 1, 5, 1, 2, 6;
  EXPECT_EQ(obj_text(test::make_points({{0, 0.5, -1}}), {}, lines), "v 0 0.5 -1\nl 1 2\nl 2 3\nl 6 7\n");
}

TEST(Triangulate, FansFromTheFirstCorner) {
  PolygonFaces faces;
  faces.corner_begin = {0, 5, 8};
  faces.vertex = {4, 3, 2, 1, 0, 7, 8, 9};
  EXPECT_EQ(triangulate(faces), test::make_triangles({{4, 3, 2}, {4, 2, 1}, {4, 1, 0}, {7, 8, 9}}));
}

TEST(ToPolygons, IsUndoneByTriangulate) {
  const Triangles triangles = test::make_cube().triangles;
  EXPECT_EQ(triangulate(to_polygons(triangles)), triangles);
  EXPECT_THAT(to_polygons(triangles).groups, IsEmpty());
}

TEST(WithoutFaces, KeepsTheOthersWithTheirAttributes) {
  PolygonFaces faces;
  faces.corner_begin = {0, 3, 7, 10, 13};
  faces.vertex = {0, 1, 2, 0, 2, 3, 4, 4, 5, 6, 6, 7, 8};
  faces.texcoord = {10, 11, 12, 10, 12, 13, 14, 14, 15, 16, 16, 17, 18};
  faces.texcoords.resize(19);
  faces.groups = {"a", "b", "c"};
  faces.group_begin = {0, 1, 3};
  const PolygonFaces kept = without_faces(faces, {1, 2});
  EXPECT_THAT(kept.corner_begin, ElementsAre(0, 3, 6));
  EXPECT_THAT(kept.vertex, ElementsAre(0, 1, 2, 6, 7, 8));
  EXPECT_THAT(kept.texcoord, ElementsAre(10, 11, 12, 16, 17, 18));
  EXPECT_THAT(kept.group_begin, ElementsAre(0, 1, 1)) << "b is empty";
  EXPECT_EQ(kept.texcoords, faces.texcoords);
  EXPECT_EQ(without_faces(faces, {}).vertex, faces.vertex);
}

}  // namespace
}  // namespace sprung
