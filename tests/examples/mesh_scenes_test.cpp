// The examples on meshes: the main job, and the jelly on the stairs.
#include "example_run.h"
#include "examples/parity.h"
#include "geometry/mesh_import.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

using testing::ExampleRun;
using testing::Parity;

Index count_inside(const Parity& parity, const Points& positions) {
  Index count = 0;
  for (const auto& position : positions.colwise()) count += parity.inside(position) ? 1 : 0;
  return count;
}

TEST(ParityOfABunny, AgreesWithItsVolume) {
  const ImportedMesh bunny = import_mesh(std::string(SPRUNG_TEST_MESHES) + "/bunny.obj");
  const Parity parity(bunny.mesh);
  const Box3 box = bunny.report.bounds;
  constexpr int kSide = 60;
  int inside = 0;
  for (int n = 0; n < kSide * kSide * kSide; ++n) {
    const Vector3 part(n % kSide + 0.5, n / kSide % kSide + 0.5, n / (kSide * kSide) + 0.5);
    inside += parity.inside(box.min() + box.diagonal().cwiseProduct(part / kSide)) ? 1 : 0;
  }
  // A grid's error is about the cells that the surface cuts: 3 sides of 60 x 60 of them, half on each side, the square root of
  // which counts.
  EXPECT_NEAR(inside * box.volume() / (kSide * kSide * kSide), signed_volume(bunny.mesh), 0.005 * box.volume());
}

TEST(ClothOnBunny, EndsDrapedWithNoParticleInside) {
  const ExampleRun run("cloth_on_bunny", {"--mesh-path", SPRUNG_TEST_MESHES});
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  ASSERT_EQ(run.frames(), 121);
  const TriangleMesh bunny = import_mesh(run.output() / "obstacles" / "bunny.obj").mesh;
  const Parity parity(bunny);
  for (int frame = 1; frame <= run.frames(); frame += 4) {
    ASSERT_EQ(count_inside(parity, run.positions("cloth", frame)), 0) << "frame " << frame;
  }

  // Draped: it lies on the bunny, hangs down its sides to below its back, and has come to rest.
  const Points end = run.positions("cloth", run.frames());
  EXPECT_GT(run.column("contacts").back(), 200);
  EXPECT_GT(end.row(1).maxCoeff(), 0.49);  // the tip of the ears is at 0.4956 m
  EXPECT_LT(end.row(1).minCoeff(), -0.1);
  EXPECT_LT(run.column("kinetic_energy").back(), 1e-3 * run.column("kinetic_energy")[10]);
  EXPECT_LT(run.column("max_stretch").back(), 0.025);  // the limit of 2 %, its tolerance, and what contact left of it
}

TEST(JellyOnStairs, TumblesDownAndStaysOutside) {
  const ExampleRun run("jelly_on_stairs");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  const TriangleMesh stairs = import_mesh(run.output() / "obstacles" / "stairs.obj").mesh;
  const Parity parity(stairs);
  for (int frame = 1; frame <= run.frames(); ++frame) {
    const Points positions = run.positions("jelly", frame);
    ASSERT_EQ(count_inside(parity, positions), 0) << "frame " << frame;
    ASSERT_GE(positions.row(1).minCoeff(), 0.0) << "frame " << frame;
  }
  const Points end = run.positions("jelly", run.frames());
  EXPECT_GT(end.row(0).mean(), run.positions("jelly", 1).row(0).mean() + 0.5) << "it went down some steps";
  EXPECT_GT((end.rowwise().maxCoeff() - end.rowwise().minCoeff()).prod(), 0.5 * 0.4 * 0.4 * 0.4) << "it is still a jelly";
}

}  // namespace
}  // namespace sprung
