// The examples whose bodies are meshes of surfaces: the balloon and the dress.
#include "example_run.h"
#include "examples/judged_mesh.h"
#include "geometry/import/mesh_import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace sprung {
namespace {

using testing::ExampleRun;
using testing::JudgedElement;

std::filesystem::path mesh_file(const std::string& name) { return std::filesystem::path(SPRUNG_SOURCE_DIR) / "meshes" / name; }

TEST(BalloonOnSpike, IsDentedSlidesOffAndIsNeverCrossed) {
  const ExampleRun run("balloon_on_spike");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  const TriangleMesh spike = import_mesh(run.output() / "obstacles" / "spike.obj").mesh;
  const auto judge = testing::judge_of(spike, true);
  const PolygonMesh balloon = read_obj(mesh_file("balloon.obj"));
  const Triangles triangles = triangulate(balloon.faces);
  const std::vector<JudgedElement> elements = testing::judged_triangles(triangles, balloon.vertices);
  const double water = 1.1 * signed_volume(balloon.vertices, triangles);
  const double tip = spike.vertices.row(1).maxCoeff();
  double deepest_dent = 0.0;
  for (int frame = 1; frame <= run.frames(); ++frame) {
    const Points positions = run.positions("balloon", frame);
    ASSERT_EQ(judge->count_inside(positions), 0) << "frame " << frame;
    ASSERT_EQ(judge->count_crossings(elements, positions), 0) << "frame " << frame;
    ASSERT_GE(positions.row(1).minCoeff(), 0.0) << "frame " << frame;
    // The tolerance of passes.
    if (frame > 1) {
      EXPECT_NEAR(signed_volume(positions, triangles) / water, 1.0, 0.001) << "frame " << frame;
    }
    const Vector3 middle = positions.rowwise().mean();
    if (std::hypot(middle.x(), middle.z()) < 0.1) deepest_dent = std::max(deepest_dent, tip - positions.row(1).minCoeff());
  }
  // Its middle is above the needle, and parts of it are farther down than the tip. Measured: 0.27 m.
  EXPECT_GT(deepest_dent, 0.05);
  EXPECT_LT(run.positions("balloon", run.frames()).row(1).mean(), tip) << "it has slid off";
}

std::vector<std::string> other_lines(const std::filesystem::path& obj) {
  std::istringstream stream(testing::read_text(obj));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("v ")) lines.push_back(line);
  }
  return lines;
}

/// Vertices of the last row of each panel.
double hem_radius(const Points& dress) {
  constexpr Index kRow = 33;
  const Index panel = static_cast<Index>(dress.cols()) / 2;
  double sum = 0.0;
  for (const Index end : {panel, 2 * panel}) {
    for (Index i = end - kRow; i < end; ++i) sum += std::hypot(dress(0, i), dress(2, i)) / (2 * kRow);
  }
  return sum;
}

TEST(Dress, FlaresOutAsTheFigureTurnsAndKeepsItsFile) {
  const ExampleRun run("dress");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  const PolygonMesh dress = read_obj(mesh_file("dress.obj"));
  const Points start = run.positions("dress", 1);
  ASSERT_EQ(start, dress.vertices) << "the order of the file";
  const std::vector<std::string> lines = other_lines(mesh_file("dress.obj"));
  ASSERT_GT(std::ranges::count_if(lines, [](const std::string& line) { return line.starts_with("vt "); }), 1000);

  const std::vector<JudgedElement> elements = testing::judged_triangles(triangulate(dress.faces), dress.vertices);
  std::vector<std::pair<Index, Index>> seams;
  for (Index i = 0; i < start.cols(); ++i) {
    for (Index j = i + 1; j < start.cols(); ++j) {
      if (start.col(i) == start.col(j)) seams.emplace_back(i, j);
    }
  }
  EXPECT_EQ(seams.size(), 2 * 22U) << "two seams from the collar to the hem";

  double widest = 0.0;
  for (int frame = 1; frame <= run.frames(); ++frame) {
    const Points positions = run.positions("dress", frame);
    widest = std::max(widest, hem_radius(positions));
    for (const auto& [i, j] : seams) ASSERT_EQ(positions.col(i), positions.col(j)) << "a seam opens in frame " << frame;
    // The collar turns with the figure: smoothly by 540 degrees from 0.6 s to 2.6 s.
    const double part = std::clamp(((frame - 1) / 30.0 - 0.6) / 2.0, 0.0, 1.0);
    const double angle = 3.0 * std::numbers::pi * part * part * (3.0 - 2.0 * part);
    const Vector3 collar = Eigen::AngleAxisd(angle, Vector3::UnitY()) * start.col(0);
    ASSERT_LT((positions.col(0) - collar).norm(), 1e-9) << "frame " << frame;
    if (frame % 3 != 1) continue;
    const TriangleMesh figure = run.obstacle("figure", frame);
    const auto judge = testing::judge_of(figure, true);
    ASSERT_EQ(judge->count_inside(positions), 0) << "frame " << frame;
    ASSERT_EQ(judge->count_crossings(elements, positions), 0) << "frame " << frame;
    ASSERT_EQ(testing::count_self_crossings(elements, positions), 0) << "frame " << frame;
  }
  for (const char* frame : {"0001", "0061"}) {
    EXPECT_EQ(other_lines(run.output() / "dress" / (std::string("dress.") + frame + ".obj")), lines)
        << "UVs, groups and faces stay";
  }
  // Measured: 0.26 m when the turn begins, 0.59 m in it.
  EXPECT_GT(widest, 1.5 * hem_radius(run.positions("dress", 19)));
}

}  // namespace
}  // namespace sprung
