#include "geometry/import/mesh_import.h"

#include "base/as_nobody.h"
#include "base/error.h"
#include "base/format.h"
#include "geometry/fixtures.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/topology.h"
#include "mesh_writers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>

#ifdef __SANITIZE_ADDRESS__
// assimp leaks memory when it refuses a damaged file.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }
#endif

namespace sprung {
namespace {

using testing::HasSubstr;

// Closed, without any symmetry, and with coordinates that are not floats.
TriangleMesh reference_shape() {
  TriangleMesh mesh = test::make_cube();
  std::mt19937 random(11);
  for (double& coordinate : mesh.vertices.reshaped()) coordinate += static_cast<double>(random() % 1000) / 3000.0;
  return mesh;
}

// Binary coordinates are rounded to the nearest float.
double float_tolerance(const TriangleMesh& mesh) {
  return std::numeric_limits<float>::epsilon() * mesh.vertices.cwiseAbs().maxCoeff();
}

// The vertex of `mesh` at `p`, or none.
Index vertex_at(const TriangleMesh& mesh, const Vector3& p, double tolerance) {
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    if ((mesh.vertices.col(i) - p).cwiseAbs().maxCoeff() <= tolerance) return i;
  }
  return kNone;
}

std::set<std::array<Index, 3>> face_set(const Triangles& triangles, const std::vector<Index>& number) {
  std::set<std::array<Index, 3>> faces;
  for (const auto& triangle : triangles.colwise()) {
    std::array<Index, 3> corners{number[triangle[0]], number[triangle[1]], number[triangle[2]]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.insert(corners);
  }
  return faces;
}

void expect_same_surface(const TriangleMesh& mesh, const TriangleMesh& expected) {
  ASSERT_EQ(mesh.vertices.cols(), expected.vertices.cols());
  std::vector<Index> number;
  std::vector<Index> same;
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    number.push_back(vertex_at(expected, mesh.vertices.col(i), float_tolerance(expected)));
    same.push_back(i);
    ASSERT_NE(number.back(), kNone) << "vertex " << i << " is missing in the reference";
  }
  EXPECT_EQ(face_set(mesh.triangles, number), face_set(expected.triangles, same));
}

std::string big_endian_ply(const TriangleMesh& mesh) {
  std::string bytes = meshes::ply_bytes(mesh);
  bytes.replace(bytes.find("little"), 6, "big");
  std::size_t at = bytes.find("end_header\n") + 11;
  const auto swap_values = [&](Index count) {
    for (Index i = 0; i < count; ++i, at += 4) std::reverse(bytes.begin() + at, bytes.begin() + at + 4);
  };
  swap_values(static_cast<Index>(mesh.vertices.size()));
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    ++at;
    swap_values(3);
  }
  return bytes;
}

std::string obj(const TriangleMesh& mesh) { return obj_text(mesh.vertices, to_polygons(mesh.triangles), Edges(2, 0)); }

const meshes::Place kHere{"[1, 1, 1]", "[0, 0, 0, 1]", "[0, 0, 0]"};

std::string gltf(const TriangleMesh& mesh) { return meshes::gltf_text(mesh, kHere, kHere); }

std::string glb(const TriangleMesh& mesh) { return meshes::glb_bytes(gltf(mesh)); }

struct Format {
  const char* name;
  std::string (*write)(const TriangleMesh&);
};

class ImportFormat : public test::FileTest, public testing::WithParamInterface<Format> {};

TEST_P(ImportFormat, GivesTheSameWeldedMesh) {
  const auto [mesh, report] = import_mesh(write(GetParam().name, GetParam().write(reference_shape())));
  expect_same_surface(mesh, reference_shape());
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.faces_read, 12);
  EXPECT_EQ(report.flipped_faces + report.degenerate_faces + report.duplicate_faces + report.unused_vertices, 0);
}

TEST_P(ImportFormat, RefusesAPositionThatIsNotFinite) {
  TriangleMesh mesh = reference_shape();
  mesh.vertices(1, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)import_mesh(write(GetParam().name, GetParam().write(mesh))), InputError);
}

// Every prefix is refused with a reason. Only a missing last digit or line end may stay unnoticed.
TEST_P(ImportFormat, RefusesEveryTruncation) {
  const std::string whole = GetParam().write(reference_shape());
  for (std::size_t length = 0; length + 3 < whole.size(); length += 1 + whole.size() / 97) {
    try {
      const MeshReport report = import_mesh(write(GetParam().name, whole.substr(0, length))).report;
      // An OBJ file declares no counts: cut between two lines it is a whole file with fewer faces.
      EXPECT_STREQ(GetParam().name, "shape.obj") << "accepted " << length << " of " << whole.size() << " bytes";
      EXPECT_FALSE(report.closed);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(GetParam().name));
    }
  }
}

// No crash, no endless loop and no index out of range.
TEST_P(ImportFormat, SurvivesDamage) {
  const std::string whole = GetParam().write(reference_shape());
  std::mt19937 random(5);
  for (int trial = 0; trial < 150; ++trial) {
    std::string damaged = whole;
    for (int hit = 0; hit < 3; ++hit) damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      const TriangleMesh mesh = import_mesh(write(GetParam().name, damaged)).mesh;
      EXPECT_LT(mesh.triangles.maxCoeff(), mesh.vertices.cols());
      EXPECT_TRUE(mesh.vertices.allFinite());
    } catch (const InputError& error) {
      EXPECT_FALSE(error.problems().empty());
    }
  }
}

class ImportText : public ImportFormat {};

// Welding, repairs and triangulation move no vertex.
TEST_P(ImportText, PositionsAreTheDoublesOfTheText) {
  const TriangleMesh mesh = import_mesh(write(GetParam().name, GetParam().write(reference_shape()))).mesh;
  const TriangleMesh expected = reference_shape();
  ASSERT_EQ(mesh.vertices.cols(), expected.vertices.cols());
  for (const auto& vertex : mesh.vertices.colwise()) EXPECT_NE(vertex_at(expected, vertex, 0.0), kNone) << vertex.transpose();
}

INSTANTIATE_TEST_SUITE_P(All, ImportText,
                         testing::Values(Format{"shape.obj", obj}, Format{"shape.stl", meshes::stl_text},
                                         Format{"shape.ply", meshes::ply_text}, Format{"shape.off", meshes::off_text}),
                         [](const auto& parameter) { return std::string(parameter.param.name).substr(6); });

INSTANTIATE_TEST_SUITE_P(All, ImportFormat,
                         testing::Values(Format{"shape.obj", obj}, Format{"shape.stl", meshes::stl_bytes},
                                         Format{"shape_ascii.stl", meshes::stl_text}, Format{"shape.ply", meshes::ply_bytes},
                                         Format{"shape_ascii.ply", meshes::ply_text}, Format{"shape_big.ply", big_endian_ply},
                                         Format{"shape.off", meshes::off_text}, Format{"shape.gltf", gltf},
                                         Format{"shape.glb", glb}, Format{"shape.3ds", meshes::three_ds_bytes}),
                         [](const auto& parameter) {
                           std::string name = parameter.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

class ImportMesh : public test::FileTest {
 protected:
  [[nodiscard]] std::string error_of(const std::filesystem::path& file) const {
    try {
      (void)import_mesh(file);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.filename().string()));
      return error.what();
    }
    return "accepted";
  }

  [[nodiscard]] std::string error_of(const std::string& name, const std::string& bytes) const {
    return error_of(write(name, bytes));
  }
};

TEST_F(ImportMesh, WeldsAcrossAnUvSeam) {
  const std::string quad =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/5 3/4 4/4\n";
  EXPECT_EQ(import_mesh(write("seam.obj", quad)).mesh.vertices.cols(), 4);
}

TEST_F(ImportMesh, WeldsAcrossMaterials) {
  std::string text = obj(test::make_cube());
  text.insert(text.find("f "), "usemtl red\n");
  std::size_t middle = text.find("f ");
  for (int face = 0; face < 6; ++face) middle = text.find("f ", middle + 1);
  text.insert(middle, "usemtl blue\n");
  const auto [mesh, report] = import_mesh(write("two.obj", text));
  EXPECT_EQ(mesh.vertices, test::make_cube().vertices);
  EXPECT_EQ(report.vertices_read, 8);
  EXPECT_TRUE(report.closed);
}

TEST_F(ImportMesh, LeavesLinesOut) {
  const auto [mesh, report] = import_mesh(write("line.obj", obj(test::make_cube()) + "l 1 8\nl 2 3 4\n"));
  EXPECT_EQ(report.faces_read, 12);
  EXPECT_TRUE(report.closed);
}

TEST_F(ImportMesh, AcceptsIndentedLinesAndCoordinatesWithoutADigitBeforeThePoint) {
  const auto file = write("points.obj", "v 0 0 0\nv .5 0 0\n\tv\t0 +.5 0\nv -.5 .25 .0\nf 1 2 3\n  f 1 3\t4\n");
  const TriangleMesh mesh = import_mesh(file).mesh;
  EXPECT_EQ(mesh.vertices, (Points(3, 4) << 0, 0.5, 0, -0.5, 0, 0, 0.5, 0.25, 0, 0, 0, 0).finished());
  EXPECT_EQ(mesh.triangles.cols(), 2);
}

std::string replaced(const std::string& text, const std::string& end) {
  std::string result;
  for (const char c : text) result += c == '\n' ? end : std::string(1, c);
  return result;
}

// The text in UTF-16, for ASCII text.
std::string two_bytes_each(const std::string& text, bool big_endian) {
  std::string bytes;
  for (const char c : text) (bytes += big_endian ? '\0' : c) += big_endian ? c : '\0';
  return bytes;
}

TEST_P(ImportText, EncodingsAndLineEndsDoNotMatter) {
  const std::string text = GetParam().write(reference_shape());
  const TriangleMesh expected = import_mesh(write(GetParam().name, text)).mesh;
  for (const std::string& written :
       {"\xEF\xBB\xBF" + text, two_bytes_each(text, false), two_bytes_each(text, true), "\xFF\xFE" + two_bytes_each(text, false),
        "\xFE\xFF" + two_bytes_each(text, true), replaced(text, "\r\n"), replaced(text, "\r")}) {
    const std::filesystem::path file = write(GetParam().name, written);
    EXPECT_EQ(import_mesh(file).mesh.vertices, expected.vertices);
    EXPECT_EQ(import_mesh(file).mesh.triangles, expected.triangles);
    if (file.extension() != ".obj") continue;
    EXPECT_EQ(read_obj(file).vertices, reference_shape().vertices);
  }
}

// 10 is the code of a line feed.
TEST_F(ImportMesh, ABinaryPlyBodyMayBeginWithALineFeed) {
  TriangleMesh cube = test::make_cube();
  const float first = std::bit_cast<float>(10U);
  cube.vertices(0, 0) = first;
  std::string bytes = meshes::ply_bytes(cube);
  const std::size_t body = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes[body], '\n');
  const TriangleMesh mesh = import_mesh(write("a.ply", replaced(bytes.substr(0, body), "\r") + bytes.substr(body))).mesh;
  EXPECT_EQ(mesh.vertices, cube.vertices);
}

TEST_F(ImportMesh, TriangulatesPolygonsThatAreNotConvex) {
  const std::string ell = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 2 3 4 5 6 1\n";
  const TriangleMesh mesh = import_mesh(write("ell.obj", ell)).mesh;
  double area = 0.0;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) area += 0.5 * area_normal(mesh, t).norm();
  EXPECT_DOUBLE_EQ(area, 3.0);
}

TEST_F(ImportMesh, AppliesNodeTransforms) {
  const meshes::Place outer{"[1, 1, 1]", "[0, 0, 0, 1]", "[10, 0, 0]"};
  const meshes::Place inner{"[2, 3, 4]", "[0, 0.7071067811865476, 0, 0.7071067811865476]", "[0, 5, 0]"};
  const auto [mesh, report] = import_mesh(write("nodes.gltf", meshes::gltf_text(test::make_cube(), outer, inner)));
  // A quarter turn about y maps x to -z and z to x. The quaternion consists of floats: an error of 2^-24 in each of three products.
  const double tolerance = 4.0 * 3.0 * std::numeric_limits<float>::epsilon();
  EXPECT_LE((report.bounds.min() - Vector3(10, 5, -2)).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LE((report.bounds.max() - Vector3(14, 8, 0)).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_NEAR(signed_volume(mesh), 24.0, 24.0 * tolerance);
}

TEST_F(ImportMesh, KeepsTheFrontSideOfAMirroredSheet) {
  const TriangleMesh sheet{test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), test::make_triangles({{0, 1, 2}})};
  const meshes::Place mirror{"[-1, 1, 1]", "[0, 0, 0, 1]", "[0, 0, 0]"};
  const TriangleMesh mesh = import_mesh(write("mirror.gltf", meshes::gltf_text(sheet, kHere, mirror))).mesh;
  EXPECT_GT(area_normal(mesh, 0).z(), 0.0);
}

TEST_F(ImportMesh, AcceptsAnyCaseOfTheExtension) {
  EXPECT_TRUE(import_mesh(write("CUBE.OBJ", obj(test::make_cube()))).report.closed);
}

TEST_F(ImportMesh, RefusesMissingAndEmptyFilesAndFolders) {
  EXPECT_THAT(error_of(folder() / "missing.obj"), HasSubstr("does not exist"));
  std::filesystem::create_directory(folder() / "folder.obj");
  EXPECT_THAT(error_of(folder() / "folder.obj"), HasSubstr("is a folder"));
  EXPECT_THAT(error_of("empty.stl", ""), HasSubstr("is empty"));
}

// To read them would wait for ever, or take all memory.
TEST_F(ImportMesh, RefusesPipesAndDevices) {
  ASSERT_EQ(::mkfifo((folder() / "pipe.obj").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder() / "zero.obj");
  for (const char* name : {"pipe.obj", "zero.obj"})
    EXPECT_THAT(error_of(folder() / name), HasSubstr("is not a regular file")) << name;
}

TEST_F(ImportMesh, RefusesAFileWithoutReadPermission) {
  const std::filesystem::path file = write("secret.obj", obj(test::make_cube()));
  std::filesystem::permissions(file, std::filesystem::perms::none);
  const test::AsNobody nobody;
  EXPECT_THAT(error_of(file), HasSubstr("cannot be read: Permission denied"));
}

TEST_F(ImportMesh, RefusesOtherFormatsAndListsTheReadableOnes) {
  for (const std::string extension : {".raw", ".dae", ".fbx", ".blend", ".x", ".step9", ""}) {
    EXPECT_THAT(
        error_of("cube" + extension, "slab\n1 0 0 0 0 0\n"),
        testing::AllOf(HasSubstr(extension + ": must be a mesh in one of the formats .obj, .stl, .ply, .off, .gltf, .glb, .3ds"),
                       HasSubstr("convert its surface to OBJ")));
  }
}

TEST_F(ImportMesh, RefusesFilesWithoutASurface) {
  EXPECT_THAT(error_of("points.obj", "v 0 0 0\nv 1 0 0\n"), HasSubstr("has no faces"));
  EXPECT_THAT(error_of("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), HasSubstr("has no face with an area"));
}

TEST_F(ImportMesh, RefusesIndicesOutOfRange) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(error_of("a.off", off + "3 0 1 3\n"), HasSubstr("line 6"));
  EXPECT_THAT(error_of("a.off", off + "3 0 -1 2\n"), HasSubstr("line 6"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), HasSubstr("one of the 3 vertices"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4294967299\n"), HasSubstr("line 4"));
  TriangleMesh cube = test::make_cube();
  cube.triangles(2, 5) = 8;
  EXPECT_THAT(error_of("a.ply", meshes::ply_bytes(cube)), HasSubstr("face 6 must refer to one of the 8 vertices"));
  EXPECT_THAT(error_of("a.gltf", gltf(cube)), HasSubstr("must refer to one of the 8 vertices"));
  EXPECT_THAT(error_of("a.3ds", meshes::three_ds_bytes(cube)), HasSubstr("face 6 must refer to one of the 8 vertices"));
}

TEST_F(ImportMesh, RefusesHeadersThatDeclareMoreThanTheFileContains) {
  EXPECT_THAT(error_of("a.off", "OFF\n4000000000 1 0\n0 0 0\n"), HasSubstr("is truncated"));
  std::string ply = meshes::ply_text(test::make_cube());
  EXPECT_THAT(error_of("a.ply", ply.replace(ply.find("vertex 8"), 8, "vertex 4000000000")), HasSubstr("4000000000"));
  EXPECT_THAT(error_of("b.ply", "ply\nformat ascii 1.0\nelement ver"), HasSubstr("header"));
  std::string stl = meshes::stl_bytes(test::make_cube());
  stl[83] = '\x7f';
  EXPECT_THAT(error_of("a.stl", stl), HasSubstr("it declares 2130706444 faces"));
}

}  // namespace
}  // namespace sprung
