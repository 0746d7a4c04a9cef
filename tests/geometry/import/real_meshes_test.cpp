// The meshes of Debian's glmark2-data, and the environments of this repository.
#include "geometry/fixtures.h"
#include "geometry/import/mesh_import.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/topology.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

namespace sprung {
namespace {

ImportedMesh import_real(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(SPRUNG_TEST_MESHES) / name;
  if (!std::filesystem::exists(file)) {
    ADD_FAILURE() << file << " is missing: install glmark2-data (tests/run.sh does), or set SPRUNG_TEST_MESHES";
  }
  return import_mesh(file);
}

TEST(RealMesh, BunnyIsOneClosedSurface) {
  const auto [mesh, report] = import_real("bunny.obj");
  EXPECT_EQ(mesh.vertices.cols(), 34835);
  EXPECT_EQ(mesh.triangles.cols(), 69666);
  EXPECT_EQ(report.components, 1);
  EXPECT_EQ(report.flipped_faces, 0);
  EXPECT_TRUE(report.closed);
}

TEST(RealMesh, BunnyWithHalfItsFacesFlippedIsTurnedBack) {
  const TriangleMesh bunny = import_real("bunny.obj").mesh;
  TriangleMesh damaged = bunny;
  std::mt19937 random(2);
  Index flipped = 0;
  for (Index t = 0; t < damaged.triangles.cols(); ++t) {
    if (random() % 2 == 0) continue;
    std::swap(damaged.triangles(1, t), damaged.triangles(2, t));
    ++flipped;
  }
  const auto [mesh, report] = clean_mesh(damaged);
  EXPECT_EQ(mesh.triangles, bunny.triangles);
  EXPECT_EQ(report.flipped_faces, flipped);
  EXPECT_GT(signed_volume(mesh), 0.0);
}

TEST(RealMesh, CatIsReadFrom3ds) {
  const auto [mesh, report] = import_real("cat.3ds");
  EXPECT_EQ(mesh.triangles.cols(), 14348);
  EXPECT_EQ(mesh.vertices.cols(), 7340);
  EXPECT_EQ(report.components, 3);
  EXPECT_EQ(report.border_edges, 330);
}

TEST(RealMesh, HorseIsReadFrom3ds) {
  const auto [mesh, report] = import_real("horse.3ds");
  EXPECT_EQ(mesh.vertices.cols(), 3582);
  EXPECT_EQ(report.components, 1);
  EXPECT_EQ(report.duplicate_faces, 12);  // six quads exist with both diagonals
  EXPECT_TRUE(report.closed);
  EXPECT_GT(signed_volume(mesh), 0.0);
}

struct Environment {
  const char* file;
  Index triangles;
  bool closed;
  Vector3 size;  // [m]
};

class EnvironmentMesh : public testing::TestWithParam<Environment> {};

TEST_P(EnvironmentMesh, ImportsAsTheReadmeSays) {
  const Environment& environment = GetParam();
  const auto [mesh, report] = import_mesh(std::filesystem::path(SPRUNG_SOURCE_DIR) / "meshes" / environment.file);
  EXPECT_EQ(mesh.triangles.cols(), environment.triangles);
  EXPECT_EQ(report.closed, environment.closed);
  EXPECT_EQ(report.components, 1);
  EXPECT_EQ(report.degenerate_faces + report.duplicate_faces + report.flipped_faces + report.unused_vertices, 0);
  EXPECT_LE((report.bounds.sizes() - environment.size).cwiseAbs().maxCoeff(), 1e-3);  // the README gives millimetres at most
  EXPECT_TRUE(report.notes.empty());
}

INSTANTIATE_TEST_SUITE_P(All, EnvironmentMesh,
                         testing::Values(Environment{"stairs.obj", 272, true, {2.4, 1.44, 1.5}},
                                         Environment{"funnel.stl", 1536, true, {1.2, 1.0, 1.2}},
                                         Environment{"torus.ply", 1920, true, {1.3, 0.3, 1.3}},
                                         Environment{"terrain.gltf", 3200, false, {4.0, 0.554, 4.0}},
                                         Environment{"spike.off", 576, true, {1.0, 0.55, 1.0}},
                                         Environment{"thin_sheet.obj", 512, false, {1.0, 0.0, 1.0}}),
                         [](const auto& parameter) {
                           const std::string name = parameter.param.file;
                           return name.substr(0, name.find('.'));
                         });

TEST(EnvironmentSequence, ImportsAsTheReadmeSays) {
  std::vector<std::filesystem::path> files;
  for (int frame = 1; frame <= 8; ++frame) {
    files.push_back(std::filesystem::path(SPRUNG_SOURCE_DIR) / "meshes/waves" / ("waves." + std::to_string(frame) + ".obj"));
  }
  const auto [sequence, report] = import_sequence(files);
  EXPECT_EQ(sequence.triangles.cols(), 672);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.welded_vertices + report.degenerate_faces + report.flipped_faces + report.unused_vertices, 0);
  EXPECT_LE((report.bounds.sizes() - Vector3(1.8, 0.48, 1.8)).cwiseAbs().maxCoeff(), 1e-3);
  for (const Points& frame : sequence.frames) EXPECT_GT(signed_volume(frame, sequence.triangles), 0.0);
}

}  // namespace
}  // namespace sprung
