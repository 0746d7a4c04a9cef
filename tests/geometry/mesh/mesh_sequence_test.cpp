#include "geometry/mesh/mesh_sequence.h"
#include "base/error.h"
#include "geometry/fixtures.h"
#include "geometry/mesh/polygon_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sprung {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::Field;
using testing::HasSubstr;

// Three frames of one triangle: it lies at 0, at 1 and at 4 m along x.
MeshSequence sliding(bool loop) {
  MeshSequence sequence{
      .triangles = test::make_triangles({{0, 1, 2}}), .frames = {}, .frame_rate = 2.0, .start = 1.0, .loop = loop};
  for (const double x : {0.0, 1.0, 4.0}) sequence.frames.push_back(test::make_points({{x, 0, 0}, {x, 1, 0}, {x, 0, 1}}));
  return sequence;
}

double x_at(const MeshSequence& sequence, double time) {
  Points positions;
  sequence.positions(sequence.at(time), positions);
  EXPECT_EQ(positions.col(1), sequence.position(1, sequence.at(time)));
  EXPECT_EQ(positions(1, 1), 1.0);
  return positions(0, 1);
}

TEST(MeshSequence, VerticesMoveInStraightLinesBetweenFramesAndRestOutside) {
  const MeshSequence sequence = sliding(false);
  EXPECT_EQ(x_at(sequence, -7.0), 0.0);
  EXPECT_EQ(x_at(sequence, 1.0), 0.0);
  EXPECT_EQ(x_at(sequence, 1.125), 0.25);
  EXPECT_EQ(x_at(sequence, 1.5), 1.0);
  EXPECT_EQ(x_at(sequence, 1.75), 2.5);
  EXPECT_EQ(x_at(sequence, 2.0), 4.0);
  EXPECT_EQ(x_at(sequence, 1e9), 4.0);
}

TEST(MeshSequence, ALoopContinuesFromTheLastFrameToTheFirst) {
  const MeshSequence sequence = sliding(true);
  EXPECT_EQ(x_at(sequence, 2.0), 4.0);
  EXPECT_EQ(x_at(sequence, 2.25), 2.0);
  EXPECT_EQ(x_at(sequence, 2.5), 0.0);
  EXPECT_EQ(x_at(sequence, 2.625), 0.25);
  EXPECT_EQ(x_at(sequence, 1.0 + 1.5 * 1000000 + 0.75), 2.5);
  EXPECT_EQ(x_at(sequence, 0.75), 2.0) << "also before the start";
  EXPECT_EQ(x_at(sequence, std::nextafter(1.0, 0.0)), 0.0);
}

TEST(MeshSequence, StepsAtFrameTimesGiveTheFramesBitForBit) {
  MeshSequence sequence{.triangles = test::make_triangles({{0, 1, 2}}), .frames = {}, .frame_rate = 24.0};
  for (int k = 0; k < 100; ++k) {
    const double x = std::sin(k);
    sequence.frames.push_back(test::make_points({{x, 0, 0}, {x, 1, 0}, {x, 0, 1}}));
  }
  const double step = 1.0 / (24.0 * 7.0);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(x_at(sequence, 7 * k * step), std::sin(k));
}

TEST(MeshSequence, PositionsLieBetweenThoseOfTheFramesToTheLastBit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  const double almost_one = std::nextafter(1.0, 0.0);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 a(between(random), between(random) * 1e-17, 1.0);
    const Vector3 b(between(random), between(random), i % 3 == 0 ? std::nextafter(1.0, 2.0) : 1.0);
    const MeshSequence sequence{.triangles = {}, .frames = {a, b}, .frame_rate = 1.0};
    for (const double fraction : {std::abs(between(random)), almost_one, std::nextafter(almost_one, 0.0)}) {
      const Vector3 at = sequence.position(0, {0, 1, fraction});
      EXPECT_TRUE((at.array() >= a.cwiseMin(b).array()).all() && (at.array() <= a.cwiseMax(b).array()).all()) << i;
    }
  }
}

TEST(MeshSequence, DeformsWhenAFrameDiffers) {
  MeshSequence sequence = sliding(false);
  EXPECT_TRUE(sequence.deforms());
  sequence.frames = {sequence.frames[0], sequence.frames[0]};
  EXPECT_FALSE(sequence.deforms());
}

// The faces of a cube, each with its own vertices; twice as large in the second frame.
MeshSequence growing_soup() {
  const TriangleMesh cube = test::make_cube();
  MeshSequence soup{.triangles = Triangles(3, 12), .frames = {Points(3, 36)}};
  for (Index i = 0; i < 36; ++i) {
    soup.frames[0].col(i) = cube.vertices.col(cube.triangles(i));
    soup.triangles(i) = i;
  }
  soup.frames.push_back(2.0 * soup.frames[0]);
  return soup;
}

TEST(CleanSequence, WeldsVerticesThatCoincideInEveryFrame) {
  const auto [sequence, report] = clean_sequence(growing_soup());
  EXPECT_EQ(sequence.frames[0].cols(), 8);
  EXPECT_EQ(sequence.frames[1], 2.0 * sequence.frames[0]);
  EXPECT_EQ(report.welded_vertices, 28);
  EXPECT_TRUE(report.closed);
  EXPECT_DOUBLE_EQ(signed_volume(sequence.frames[1], sequence.triangles), 8.0);
  EXPECT_EQ(report.bounds.max(), Vector3(2, 2, 2));
}

TEST(CleanSequence, KeepsVerticesApartThatCoincideInSomeFramesOnly) {
  MeshSequence torn = growing_soup();
  torn.frames[1].col(0) += Vector3(-1, -1, -1);
  const auto [sequence, report] = clean_sequence(torn);
  EXPECT_EQ(sequence.frames[0].cols(), 9);
  EXPECT_FALSE(report.closed) << "one vertex leaves those at its position";
}

TEST(CleanSequence, DropsFacesWithoutAreaInAnyFrame) {
  const MeshSequence raw{
      .triangles = test::make_triangles({{0, 1, 2}, {0, 3, 1}, {0, 4, 1}}),
      .frames = {test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.25, 0, 0}}),
                 test::make_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, -1, 0}, {0.75, 0, 0}})},
  };
  const auto [sequence, report] = clean_sequence(raw);
  EXPECT_EQ(report.degenerate_faces, 1);
  EXPECT_EQ(report.unused_vertices, 1);
  EXPECT_EQ(sequence.triangles, test::make_triangles({{0, 1, 2}, {0, 3, 1}}));
  EXPECT_EQ(sequence.frames[1].col(3), Vector3(0.5, -1, 0));
}

TEST(CleanSequence, OrientsByTheFirstFrame) {
  TriangleMesh cube = test::inside_out(test::make_cube());
  const MeshSequence raw{.triangles = cube.triangles, .frames = {cube.vertices, 3.0 * cube.vertices}};
  const auto [sequence, report] = clean_sequence(raw);
  EXPECT_EQ(report.flipped_faces, 12);
  EXPECT_GT(signed_volume(sequence.frames[1], sequence.triangles), 0.0);
}

class ImportSequence : public test::FileTest {
 protected:
  static std::vector<Problem> problems(const std::vector<std::filesystem::path>& files) {
    try {
      (void)import_sequence(files);
    } catch (const InputError& error) {
      return error.problems();
    }
    return {};
  }
};

auto problem(const char* file, const char* key, const char* rule) {
  return AllOf(Field(&Problem::file, EndsWith(file)), Field(&Problem::key, key), Field(&Problem::rule, HasSubstr(rule)),
               Field(&Problem::remedy, testing::Not("")));
}

constexpr const char* kFaces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(ImportSequence, KeepsNumbersVerticesAndTheOrderOfFiles) {
  const auto text = [](const char* tip) { return std::string("v 0 0 0\nv 0.1 0 0\nv 0 1 0\nv 0 0 ") + tip + "\n" + kFaces; };
  const auto [sequence, report] =
      import_sequence({write("b.obj", text("1")), write("a.obj", text("2")), write("c.obj", text("0.3"))});
  ASSERT_EQ(sequence.frames.size(), 3U);
  EXPECT_EQ(sequence.frames[1].col(3), Vector3(0, 0, 2));
  EXPECT_EQ(sequence.frames[2].col(3), Vector3(0, 0, 0.3));
  EXPECT_EQ(sequence.frames[2](0, 1), 0.1) << "not the float nearest to it";
  EXPECT_EQ(report.faces_read, 4);
  EXPECT_TRUE(report.closed);
}

TEST_F(ImportSequence, PolygonsAreTriangulatedAlikeInAllFrames) {
  const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  const ImportedSequence imported = import_sequence({write("a.obj", quad), write("b.obj", "v 0 0 1\n" + quad.substr(8))});
  EXPECT_EQ(imported.sequence.triangles, test::make_triangles({{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(imported.sequence.frames[1].col(0), Vector3(0, 0, 1));
}

TEST_F(ImportSequence, RefusesFramesOfAnotherTopologyAllAtOnce) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const auto good = write("good.obj", vertices + kFaces);
  const auto more = write("more.obj", vertices + "v 5 5 5\n" + kFaces);
  const auto fewer = write("fewer.obj", vertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const auto other = write("other.obj", vertices + "f 1 3 2\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  const auto quads = write("quads.obj", vertices + "f 1 3 2\nf 1 2 4 3\nf 1 4 3\nf 2 3 4\n");
  const auto broken = write("broken.obj", vertices + "v 1 nan 3\n");
  EXPECT_THAT(problems({good, more, fewer, good, other, quads, broken, folder() / "none.obj", write("mesh.ply", "ply")}),
              ElementsAre(problem("more.obj", "", "must be equally many as in good.obj, which has 4"),
                          problem("fewer.obj", "", "must be equally many as in good.obj, which has 4"),
                          problem("other.obj", "face 3", "must have the same corners as in good.obj"),
                          problem("quads.obj", "face 2", "must have the same corners as in good.obj"),
                          AllOf(Field(&Problem::file, EndsWith("broken.obj")), Field(&Problem::key, "line 5")),
                          problem("none.obj", "", "does not exist"), problem("mesh.ply", "", "must be an OBJ file")));
}

TEST_F(ImportSequence, ABrokenFirstFileDoesNotHideTheOthers) {
  EXPECT_THAT(problems({folder() / "a.obj", folder() / "b.obj"}),
              ElementsAre(problem("a.obj", "", "does not exist"), problem("b.obj", "", "does not exist")));
}

TEST_F(ImportSequence, NamesTwentyFilesAndCountsTheOthers) {
  const std::vector<std::filesystem::path> missing(30, folder() / "a.obj");
  const std::vector<Problem> all = problems(missing);
  ASSERT_EQ(all.size(), 21U);
  EXPECT_THAT(all.back().rule, HasSubstr("10 more problems"));
}

TEST_F(ImportSequence, RefusesASequenceWithoutASurface) {
  const auto points = write("points.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\n");
  const auto line = write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_THAT(problems({points, points}), ElementsAre(problem("points.obj", "", "has no faces")));
  EXPECT_THAT(problems({line, line}), ElementsAre(problem("line.obj", "", "has no face with an area in any frame")));
}

}  // namespace
}  // namespace sprung
