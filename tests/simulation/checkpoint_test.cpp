#include "simulation/checkpoint.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "collision/sample_meshes.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace sprung {
namespace {

using ::testing::HasSubstr;
using testing::ScratchFolder;
using testing::write_text;

constexpr int kStepsPerFrame = 16;

SimulatorSettings settings() {
  SimulatorSettings settings;
  settings.step = 1.0 / 480.0;
  settings.steps_per_frame = kStepsPerFrame;
  return settings;
}

SpringNetwork cloth(int columns, const std::string& name = "cloth") {
  NetworkBuilder builder;
  BodyShape shape = make_cloth({.size = {0.5, 0.5}, .resolution = {columns, 8}}, {SpringMaterial{.value = 50.0}, {}, {}});
  set_total_mass(shape, 0.1);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = Eigen::AngleAxisd(-1.5, Vector3::UnitX()).toRotationMatrix();
  pose.translation() = Vector3(0.0, 0.3, 0.0);
  place(shape, pose);
  ContactMaterial thick;
  thick.thickness = 0.01;
  builder.add_body(name, shape, thick, {.self = true});
  Pin hand;
  hand.name = "hand";
  hand.particles = {0};
  builder.add_pin(hand);
  return builder.build();
}

Simulator drape(const SpringNetwork& network = cloth(8)) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{0.2}};
  return Simulator(network, settings(), {ball});
}

/// A frame in which the pin is moved before each step.
void steer_frame(Simulator& simulator) {
  for (int step = 0; step < kStepsPerFrame; ++step) {
    RigidTransform pose = simulator.pin_pose(0);
    pose.translation() += Vector3(0.0, 1e-5, 4e-6);
    simulator.move_pin(0, pose);
    simulator.step();
  }
}

std::string refusal(Simulator& simulator, const std::filesystem::path& file) {
  try {
    simulator.load(file);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

// The cloth touches the ball and itself, and its pin is steered.
TEST(Checkpoint, ASimulatorThatLoadsACheckpointGoesOnBitByBit) {
  const ScratchFolder scratch;
  Simulator original = drape();
  for (int frame = 1; frame <= 60; ++frame) {
    steer_frame(original);
    if (frame % 12 != 0) continue;
    original.step();  // also within a frame
    original.save(scratch / "state");
    Simulator loaded = drape();
    loaded.load(scratch / "state");
    EXPECT_TRUE(loaded.state() == original.state());
    Simulator copy = original;
    for (int k = 0; k < 2; ++k) {
      steer_frame(original);
      steer_frame(loaded);
      steer_frame(copy);
      EXPECT_TRUE(loaded.state() == original.state()) << frame << " + " << k;
      EXPECT_TRUE(copy.state() == original.state()) << frame << " + " << k;
    }
  }
  EXPECT_GT(original.contact_count(), 0);
}

// Regions and pairs of another surface name triangles and particles that need not exist.
TEST(Checkpoint, CachesOfOtherObstaclesAreIgnored) {
  const auto over = [](const TriangleMesh& mesh) {
    Obstacle ground{.name = "ground", .geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh)}};
    return Simulator(cloth(8), settings(), {ground});
  };
  const ScratchFolder scratch;
  Simulator fine = over(test::torus(0.1, 0.1, 40, 20));
  for (int frame = 1; frame <= 30; ++frame) steer_frame(fine);
  fine.save(scratch / "state");
  Simulator coarse = over(test::torus(0.1, 0.1, 6, 4));
  Simulator without_caches = over(test::torus(0.1, 0.1, 6, 4));
  coarse.load(scratch / "state");
  without_caches.restore(fine.state());
  steer_frame(coarse);
  steer_frame(without_caches);
  EXPECT_TRUE(coarse.state() == without_caches.state());
}

TEST(Checkpoint, StatesOfOtherNetworksAreRefusedByName) {
  const ScratchFolder scratch;
  Simulator wide = drape(cloth(9));
  wide.step();
  wide.save(scratch / "state");
  Simulator simulator = drape();
  const SimulationState before = simulator.state();
  EXPECT_THAT(refusal(simulator, scratch / "state"), HasSubstr("body \"cloth\" has 64 particles and "));
  drape(cloth(8, "flag")).save(scratch / "state");
  const std::string text = refusal(simulator, scratch / "state");
  EXPECT_THAT(text, HasSubstr("body \"flag\" is missing"));
  EXPECT_THAT(text, HasSubstr("body \"cloth\" is new"));
  write_text(scratch / "state", "text");
  EXPECT_THAT(refusal(simulator, scratch / "state"), HasSubstr("it is not a checkpoint of sprung"));
  EXPECT_THAT(refusal(simulator, scratch / "none"), HasSubstr("No such file"));
  EXPECT_TRUE(simulator.state() == before);
  EXPECT_NO_THROW(simulator.step());
}

TEST(Checkpoint, AFileThatCannotBeWrittenIsAnError) {
  const ScratchFolder scratch;
  write_text(scratch / "file", "");
  EXPECT_THROW(drape().save(scratch / "file/state"), FileError);
}

}  // namespace
}  // namespace sprung
