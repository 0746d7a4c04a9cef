// Minimal files that made assimp abort, crash or lose faces.
#include "base/error.h"
#include "geometry/fixtures.h"
#include "geometry/import/mesh_import.h"
#include "mesh_writers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace sprung {
namespace {

using testing::HasSubstr;

const meshes::Place kHere{"[1, 1, 1]", "[0, 0, 0, 1]", "[0, 0, 0]"};

std::string cube_gltf() { return meshes::gltf_text(test::make_cube(), kHere, kHere); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

class CheckedMesh : public test::FileTest {
 protected:
  [[nodiscard]] std::string error_of(const std::string& name, const std::string& bytes) const {
    try {
      (void)import_mesh(write(name, bytes));
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().size(), 1u);
      return error.what();
    }
    return "accepted";
  }

  [[nodiscard]] Index faces_of(const std::string& name, const std::string& bytes) const {
    return static_cast<Index>(import_mesh(write(name, bytes)).mesh.triangles.cols());
  }
};

std::string ply(const std::string& face_type, const std::string& faces) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face "
         "2\nproperty " +
         face_type + "\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + faces;
}

const std::string kList = "list uchar int vertex_indices";

TEST_F(CheckedMesh, PlyFacesMustHaveCorners) {
  EXPECT_THAT(error_of("a.ply", ply(kList, "3 0 1 2\n0\n")), HasSubstr("face 2 must have one list of 1 to 10000 corners"));
  EXPECT_THAT(error_of("a.ply", ply(kList, "3 0 1 2\n-1\n")), HasSubstr("face 2 must have one list"));
  EXPECT_THAT(error_of("a.ply", ply(kList, "3 0 1 2\n20000 0\n")), HasSubstr("face 2 must have one list"));
  EXPECT_EQ(faces_of("a.ply", ply(kList, "3 0 1 2\n2 0 1\n")), 1);
}

TEST_F(CheckedMesh, PlyFacesMaySpanSeveralLines) { EXPECT_EQ(faces_of("a.ply", ply(kList, "3 0\n1 2 3 0 1 3")), 2); }

TEST_F(CheckedMesh, PlyCornersMustBeIntegersInRange) {
  EXPECT_THAT(error_of("a.ply", ply(kList, "3 0 1 2\n3 0 1 -1\n")), HasSubstr("face 2 must refer to one of the 4 vertices"));
  EXPECT_THAT(error_of("a.ply", ply("list uchar float vertex_indices", "3 0 1 2\n3 0 1 3\n")), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of("a.ply", ply("list float int vertex_indices", "3 0 1 2\n3 0 1 3\n")), HasSubstr("not an integer"));
}

TEST_F(CheckedMesh, MalformedPlyHeadersAreRefused) {
  const std::string good = ply(kList, "3 0 1 2\n3 0 1 3\n");
  ASSERT_EQ(faces_of("a.ply", good), 2);
  EXPECT_THAT(error_of("a.ply", replaced(good, "element face", "element tristrips")), HasSubstr("triangle strips"));
  EXPECT_THAT(error_of("a.ply", replaced(good, "element face", "element vertex")), HasSubstr("two elements \"vertex\""));
  EXPECT_THAT(error_of("a.ply", replaced(good, "element vertex", "element point")), HasSubstr("has no vertices"));
  EXPECT_THAT(error_of("a.ply", replaced(good, "float y", "list uchar float y")), HasSubstr("must have x, y and z"));
  EXPECT_THAT(error_of("a.ply", replaced(good, "float y", "float x")), HasSubstr("twice"));
  EXPECT_THAT(error_of("a.ply", replaced(good, "format ascii 1.0\n", "")), HasSubstr("ascii or binary"));
}

TEST_F(CheckedMesh, PlyElementsMayComeInAnyOrder) {
  const std::string file =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 3\nproperty uchar red\n"
      "property double z\nproperty int y\nproperty float x\nend_header\n3 0 1 2\n7 0 0 0\n7 0 0 1.5\n7 0.5 2 0\n";
  const TriangleMesh mesh = import_mesh(write("a.ply", file)).mesh;
  EXPECT_EQ(mesh.vertices, test::make_points({{0, 0, 0}, {1.5, 0, 0}, {0, 2, 0.5}}));
}

TEST_F(CheckedMesh, OffFacesOfManyCornersAreKept) {
  std::string off = "OFF\n12 1 0\n";
  for (int i = 0; i < 12; ++i) off += std::to_string(std::cos(i * 0.5)) + ' ' + std::to_string(std::sin(i * 0.5)) + " 0\n";
  EXPECT_EQ(faces_of("a.off", off + "12 0 1 2 3 4 5 6 7 8 9 10 11\n"), 10);
}

TEST_F(CheckedMesh, OffOfOtherDimensionsIsRefused) {
  const std::string rest = "\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n";
  EXPECT_EQ(faces_of("a.off", "COFF" + rest), 1);
  EXPECT_THAT(error_of("a.off", "4OFF" + rest), HasSubstr("dimension"));
  EXPECT_THAT(error_of("a.off", "OFF BINARY" + rest), HasSubstr("binary"));
}

TEST_F(CheckedMesh, StlTextIsReadInAnyCaseAndWithAnyName) {
  const std::string solid = "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\n";
  EXPECT_EQ(faces_of("a.stl", "SOLID vertex facet \xC3\xA9" + std::string(2000, 'x') + "\n" + solid + "ENDSOLID a\n"), 1);
  EXPECT_THAT(error_of("a.stl", "solid\n" + replaced(solid, "VERTEX 0 1 0\n", "") + "endsolid\n"),
              HasSubstr("face 1: a facet must have three"));
  EXPECT_THAT(error_of("a.stl", "solid\n" + replaced(solid, "0 1 0", "0 nan 0") + "endsolid\n"),
              HasSubstr("face 1: a vertex must have"));
  EXPECT_THAT(error_of("a.stl", "solid\n" + solid), HasSubstr("its last solid has no end"));
  EXPECT_THAT(error_of("a.stl", "facets"), HasSubstr("must begin with"));
}

TEST_F(CheckedMesh, ObjWeightsMustNotBeZero) {
  const std::string rest = "v 2 0 0 2\nv 0 1 0\nf 1 2 3\n";
  const TriangleMesh mesh = import_mesh(write("a.obj", "v 0 0 0 1 0 0\n" + rest)).mesh;
  EXPECT_EQ(mesh.vertices, test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0 0\n" + rest), HasSubstr("line 1 = 0: the weight of a vertex must not be 0"));
}

TEST_F(CheckedMesh, ObjFacesAndNamesMayBeLong) {
  const std::string name(100'000, 'n');
  EXPECT_EQ(faces_of("a.obj", "o " + name + "\ng " + name + "\nusemtl " + name + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), 1);
  std::string face = "f";
  for (int i = 0; i < 10'001; ++i) face += " 1";
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\n" + face + "\n"), HasSubstr("line 2: a face must have at most 10000 corners"));
}

TEST_F(CheckedMesh, GltfNodesMustFormTrees) {
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "{ \"mesh\": 0,", "{ \"children\": [0],")), HasSubstr("node 0 twice"));
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "\"children\": [1]", "\"children\": [7]")),
              HasSubstr("number 7 of \"nodes\""));
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "[1, 1, 1]", "[1, 1]")), HasSubstr("3 finite numbers"));
}

TEST_F(CheckedMesh, GltfAccessorsMustStayWithinTheirBuffers) {
  for (const auto& [from, to] : {std::pair{"\"byteOffset\": 0", "\"byteOffset\": 100"},
                                 {"\"count\": 8", "\"count\": 2000000000"},
                                 {"\"byteOffset\": 0", "\"byteStride\": 300"},
                                 {"\"count\": 36", "\"count\": 39"}}) {
    EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), from, to)), HasSubstr("reaches beyond its buffer"));
  }
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "\"count\": 36", "\"count\": 35")), HasSubstr("35 corners"));
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "\"VEC3\"", "\"VEC2\"")), HasSubstr("three floats"));
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "{ \"bufferView\": 0, ", "{ ")), HasSubstr("without a buffer"));
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "base64,", "base64,*")), HasSubstr("base64"));
}

TEST_F(CheckedMesh, GltfStripsAndFansAreRead) {
  const std::string gltf = replaced(cube_gltf(), "\"indices\": 1", "\"indices\": 1, \"mode\": MODE");
  EXPECT_EQ(import_mesh(write("a.gltf", replaced(gltf, "MODE", "4"))).report.faces_read, 12);
  EXPECT_EQ(import_mesh(write("a.gltf", replaced(gltf, "MODE", "5"))).report.faces_read, 34);
  EXPECT_EQ(import_mesh(write("a.gltf", replaced(gltf, "MODE", "6"))).report.faces_read, 34);
  EXPECT_THAT(error_of("a.gltf", replaced(gltf, "MODE", "1")), HasSubstr("has no faces"));
}

TEST_F(CheckedMesh, GltfOfOtherVersionsAndCompressedGltfIsRefused) {
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "\"2.0\"", "\"1.0\"")), HasSubstr("version 2.0"));
  const std::string draco = R"("extensions": { "KHR_draco_mesh_compression": {} }, "attributes")";
  EXPECT_THAT(error_of("a.gltf", replaced(cube_gltf(), "\"attributes\"", draco)), HasSubstr("Draco"));
}

TEST_F(CheckedMesh, GltfBuffersMayBeSeparateFiles) {
  // Little-endian floats of a triangle; the first index byte of each pair.
  std::string buffer(36, '\0');
  buffer.replace(12, 4, std::string("\0\0\x80\x3F", 4));
  buffer.replace(28, 4, std::string("\0\0\x80\x3F", 4));
  (void)write("triangle.bin", buffer);
  const std::string json = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]})";
  EXPECT_EQ(import_mesh(write("a.gltf", json)).mesh.vertices, test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(error_of("a.gltf", replaced(json, "triangle.bin", "missing.bin")), HasSubstr("missing.bin: does not exist"));
  const std::string binary = replaced(json, R"(, "uri": "triangle.bin")", "");
  EXPECT_EQ(faces_of("a.glb", meshes::glb_bytes(binary, buffer)), 1);
  EXPECT_THAT(error_of("a.glb", meshes::glb_bytes(binary)), HasSubstr("a buffer without content"));
}

// The parent is the last number of the file.
TEST_F(CheckedMesh, ThreeDsNodesMustHaveAnExistingParentOrNone) {
  std::string bytes = meshes::three_ds_bytes(test::make_cube());
  ASSERT_EQ(faces_of("a.3ds", bytes), 12);
  bytes[bytes.size() - 2] = '\xfe';
  EXPECT_THAT(error_of("a.3ds", bytes), HasSubstr("a node whose parent does not exist"));
}

TEST_F(CheckedMesh, ThreeDsChunksMustBeComplete) {
  const std::string good = meshes::three_ds_bytes(test::make_cube());
  EXPECT_THAT(error_of("a.3ds", good.substr(0, good.size() - 1)), HasSubstr("is truncated"));
  EXPECT_THAT(error_of("a.3ds", replaced(good, std::string("shape\0", 6), "shapes")), HasSubstr("export it again"));
  EXPECT_THAT(error_of("a.3ds", "MM"), HasSubstr("does not begin like a 3DS file"));
}

}  // namespace
}  // namespace sprung
