#include "simulation/checkpoint.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

// Caches are cleared after 4,096 steps, which are 256 frames here. The cloth touches the ball and itself, and its pin is steered.
TEST(Checkpoint, ASimulatorThatLoadsAResumableStateGoesOnBitByBit) {
  const ScratchFolder scratch;
  Simulator original = drape();
  int resumable = 0;
  for (int frame = 1; frame <= 520; ++frame) {
    steer_frame(original);
    EXPECT_EQ(is_resumable(original.state()), frame % (kStepsOfCaches / kStepsPerFrame) == 0) << frame;
    if (!is_resumable(original.state())) continue;
    ++resumable;
    original.save(scratch / "state");
    Simulator other = drape();
    other.load(scratch / "state");
    EXPECT_TRUE(other.state() == original.state());
    Simulator copy = original;
    for (int k = 0; k < 3; ++k) {
      steer_frame(original);
      steer_frame(other);
      steer_frame(copy);
      EXPECT_TRUE(other.state() == original.state()) << frame << " + " << k;
      EXPECT_TRUE(copy.state() == original.state()) << frame << " + " << k;
    }
    frame += 3;
  }
  EXPECT_EQ(resumable, 2);
  EXPECT_GT(original.contact_count(), 0);
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
