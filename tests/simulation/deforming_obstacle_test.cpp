// Contact, friction and penalty on obstacles that deform.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

using testing::kGravity;
using testing::one_particle;
using testing::run;

/// A level sheet of 8 x 8 m about the origin, two triangles per square metre.
TriangleMesh sheet() {
  constexpr Index kSide = 8;
  TriangleMesh mesh{Points(3, (kSide + 1) * (kSide + 1)), Triangles(3, 2 * kSide * kSide)};
  for (Index j = 0; j <= kSide; ++j) {
    for (Index i = 0; i <= kSide; ++i) mesh.vertices.col(j * (kSide + 1) + i) = Vector3(i - 0.5 * kSide, 0.0, j - 0.5 * kSide);
  }
  for (Index j = 0; j < kSide; ++j) {
    for (Index i = 0; i < kSide; ++i) {
      const Index a = j * (kSide + 1) + i;
      mesh.triangles.col(2 * (j * kSide + i)) << a, a + kSide + 1, a + 1;
      mesh.triangles.col(2 * (j * kSide + i) + 1) << a + 1, a + kSide + 1, a + kSide + 2;
    }
  }
  return mesh;
}

/// A sequence that moves each vertex of the mesh to `deform(position)` within one second.
template <class Deform>
Obstacle deforming(const TriangleMesh& mesh, const ContactMaterial& material, const Deform& deform) {
  MeshSequence sequence{.triangles = mesh.triangles, .frames = {mesh.vertices, mesh.vertices}, .frame_rate = 1.0};
  for (Index i = 0; i < mesh.vertices.cols(); ++i) sequence.frames[1].col(i) = deform(Vector3(mesh.vertices.col(i)));
  return {
      .name = "sheet", .geometry = SequenceGeometry{std::make_shared<const MeshSequence>(sequence), false}, .material = material};
}

class DeformingObstacle : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] SimulatorSettings settings() const { return {.step = 1e-3, .integrator = all_integrators()[GetParam()]}; }
};

INSTANTIATE_TEST_SUITE_P(Integrators, DeformingObstacle, ::testing::Range(std::size_t{0}, all_integrators().size()));

TEST_P(DeformingObstacle, ARisingSheetLiftsAParticleAtItsThickness) {
  const Obstacle rising =
      deforming(sheet(), {}, [](const Vector3& x) { return Vector3(x + Vector3(0.0, 0.5 + 0.1 * x.x(), 0.0)); });
  Simulator simulator(one_particle({0.3, 0.01, 0.2}, {.thickness = 0.01}), settings(), {rising});
  run(simulator, 0.5);
  // The final slope of 1 in 20 moves the foot of the gap by 1 % of 1/20, and the height by the slope's cosine: 1e-5 m. The
  // particle slides down by 1/2 g a t^2 with a up to 1/20, 1 cm, which is a twentieth of 1 cm in height.
  EXPECT_NEAR(simulator.positions()(1, 0), 0.01 + 0.25 + 0.5 * 0.1 * simulator.positions()(0, 0), 3e-5);
}

TEST_P(DeformingObstacle, ASlidingSequenceHasTheFrictionOfAMovedMesh) {
  const double mu = 0.2;
  const ContactMaterial rough{.thickness = 0.01, .friction = mu, .static_friction = mu};
  const Obstacle sliding = deforming(sheet(), rough, [](const Vector3& x) { return Vector3(x + Vector3(1.0, 0.0, 0.0)); });
  Obstacle moved = deforming(sheet(), rough, [](const Vector3& x) { return x; });
  moved.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {1.0, 0.0, 0.0}}};
  Simulator by_frames(one_particle({0.3, 0.02, 0.2}, rough), settings(), {sliding});
  Simulator by_motion(one_particle({0.3, 0.02, 0.2}, rough), settings(), {moved});
  run(by_frames, 0.9);
  run(by_motion, 0.9);
  // The two runs add the same displacements in different orders.
  EXPECT_LT((by_frames.positions() - by_motion.positions()).norm(), 1e-9);
  // Friction accelerates the particle to 1 m/s in 1 / (mu g) s. In that time it lags behind by half of the sheet's displacement.
  const double behind = 0.5 / (mu * kGravity);
  EXPECT_NEAR(by_frames.positions()(0, 0), 0.3 + 0.9 - behind, 2e-3);
  EXPECT_NEAR(by_frames.state().v(0, 0), 1.0, 1e-9);
}

TEST_P(DeformingObstacle, AParticleSticksToItsPointOfAStretchingSheet) {
  const ContactMaterial rough{.thickness = 0.01, .friction = 2.0, .static_friction = 2.0};
  const Obstacle stretching = deforming(sheet(), rough, [](const Vector3& x) { return Vector3(2.0 * x.x(), x.y(), x.z()); });
  Simulator simulator(one_particle({0.8, 0.02, 0.2}, rough), settings(), {stretching});
  run(simulator, 1.0);
  // The point below the particle moves from 0.8 m to 1.6 m at 0.8 m/s. Friction needs 0.8 / (mu g) s to accelerate the particle,
  // and the point is 1.6 cm away by then. The distance to the new contact point grows as the sheet stretches.
  EXPECT_NEAR(simulator.positions()(0, 0), 1.6, 2.0 * 0.5 * 0.8 * 0.8 / (2.0 * kGravity));
  EXPECT_NEAR(simulator.state().v(0, 0), simulator.positions()(0, 0) / 2.0, 1e-3);
}

TEST_P(DeformingObstacle, PenaltyFrictionFollowsTheSpeedOfTheSurface) {
  const ContactMaterial rough{.thickness = 0.01, .friction = 0.5, .static_friction = 0.5};
  SimulatorSettings chosen = settings();
  chosen.contact = {.response = ContactSettings::Response::penalty, .stiffness = 500.0, .damping = 2.0};
  const Obstacle sliding = deforming(sheet(), rough, [](const Vector3& x) { return Vector3(x + Vector3(1.0, 0.0, 0.0)); });
  Simulator simulator(one_particle({0.3, 0.009, 0.2}, rough), chosen, {sliding});
  run(simulator, 0.9);
  EXPECT_NEAR(simulator.state().v(0, 0), 1.0, 1e-6);
}

TEST_P(DeformingObstacle, AFlappingThinSheetLiftsACloth) {
  // The sheet rises by 0.8 m in a sixteenth of a second: 13 m/s, 13 mm per step, with a different speed at each square.
  const Obstacle flapping = [] {
    Obstacle obstacle = deforming(sheet(), {}, [](const Vector3& x) {
      return Vector3(x + Vector3(0.0, 0.8 + 0.2 * std::sin(3.0 * x.x()) * std::cos(2.0 * x.z()), 0.0));
    });
    MeshSequence faster = *std::get<SequenceGeometry>(obstacle.geometry).sequence;
    faster.frame_rate = 16.0;
    for (Points& frame : faster.frames) frame.topRows(1) *= 0.25;
    for (Points& frame : faster.frames) frame.bottomRows(1) *= 0.25;
    std::get<SequenceGeometry>(obstacle.geometry).sequence = std::make_shared<const MeshSequence>(faster);
    return obstacle;
  }();
  Simulator simulator(testing::cloth(9, 0.1, {.thickness = 0.005}), settings(), {flapping});
  for (int step = 0; step < 62; ++step) simulator.step();
  for (Index i = 0; i < 81; ++i) EXPECT_GT(simulator.positions()(1, i), 0.55) << i;
}

TEST(DeformingObstacle, ScalingByAPowerOfTwoScalesEveryBit) {
  const auto simulate = [](double scale) {
    BodyShape shape = make_cloth({.size = {scale, scale}, .resolution = {9, 9}}, {.structural = SpringMaterial{.value = 200.0}});
    set_total_mass(shape, 0.2);
    RigidTransform pose = RigidTransform::Identity();
    pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
    pose.translation() = Vector3(0.1 * scale, 0.02 * scale, 0.0);
    place(shape, pose, Vector3::Zero());
    NetworkBuilder builder;
    builder.add_body("cloth", shape, {.thickness = 0.005 * scale, .friction = 0.4, .static_friction = 0.5});
    TriangleMesh mesh = sheet();
    mesh.vertices *= 0.125 * scale;
    const Obstacle obstacle = deforming(mesh, {.friction = 0.4, .static_friction = 0.5}, [&](const Vector3& x) {
      const Vector3 unit = x / scale;
      return Vector3(scale * (1.2 * unit.x() + 0.3), scale * (0.5 + std::ldexp(unit.x() * unit.z(), -1)), scale * unit.z());
    });
    Simulator simulator(builder.build(), {.step = 1.0 / 512.0, .gravity = {0.0, -scale * kGravity, 0.0}}, {obstacle});
    run(simulator, 0.5);
    return Points(simulator.positions());
  };
  const Points positions = simulate(1.0);
  EXPECT_EQ(simulate(128.0), 128.0 * positions);
  EXPECT_EQ(simulate(1.0 / 128.0), positions / 128.0);
  EXPECT_GT(positions.row(1).minCoeff(), 0.1) << "the sheet lifts the cloth";
}

}  // namespace
}  // namespace sprung
