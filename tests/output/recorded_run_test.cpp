// A run reads back from its folder alone: from record.bin, and from the OBJ files where there is none.
#include "output/recorded_run.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "output/run_output.h"
#include "output/small_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::listing;
using ::testing::Not;
using testing::ScratchFolder;
using testing::small_world;

constexpr int kFrames = 3;

class RecordedWorld : public ::testing::Test {
 protected:
  void run(RunFacts facts) {
    facts.frames = kFrames;
    facts.steps_per_frame = 2;
    Simulator simulator = small_world();
    RunOutput output(OutputFolder(scratch_ / "out", true), facts, simulator);
    FrameRunner runner(simulator);
    for (int frame = 1; frame <= kFrames; ++frame) {
      output.write_frame(simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
      states_.push_back(simulator.state());
    }
    output.finish("done");
  }
  [[nodiscard]] std::filesystem::path folder() const { return scratch_ / "out"; }

  ScratchFolder scratch_;
  std::vector<SimulationState> states_;
};

TEST_F(RecordedWorld, HasTheStatesOfTheSimulatorWithAndWithoutObjFiles) {
  for (const std::vector<std::string>& formats : {std::vector<std::string>{"obj"}, {}}) {
    states_.clear();
    run({.scene_file = "world.json", .formats = formats});
    const RecordedRun recorded(folder());
    EXPECT_EQ(recorded.title(), "world.json");
    EXPECT_EQ(recorded.missing(), "");
    ASSERT_EQ(recorded.frames(), kFrames);
    for (int frame = 1; frame <= kFrames; ++frame) {
      const SimulationState& state = states_[static_cast<std::size_t>(frame - 1)];
      EXPECT_EQ(recorded.frame(frame).positions, state.x);
      EXPECT_EQ(recorded.frame(frame).velocities, state.v);
      EXPECT_DOUBLE_EQ(recorded.frame(frame).time, 0.02 * (frame - 1));
    }
    // The box rises by 0.25 m in a second.
    EXPECT_NEAR(recorded.frame(kFrames).poses[1].translation().y(), 0.5 + 0.25 * 0.04, 1e-15);
    EXPECT_EQ(recorded.model().bodies[2].faces.texcoords, testing::quad_with_uvs().faces.texcoords);
  }
  EXPECT_THAT(listing(folder()), ElementsAre("diagnostics.csv", "record.bin", "run.json"))
      << "the OBJ files of the first run are gone";
}

TEST_F(RecordedWorld, WithoutItsRecordShowsTheObjFilesAndSaysWhatIsMissing) {
  run({.write_record = false});
  EXPECT_THAT(listing(folder()), Not(Contains("record.bin")));
  const RecordedRun recorded(folder());
  EXPECT_FALSE(recorded.is_complete());
  EXPECT_THAT(recorded.missing(), HasSubstr("springs, pins, velocities and contact are missing"));
  EXPECT_EQ(recorded.model().springs.ends.cols(), 0);
  ASSERT_EQ(recorded.frames(), kFrames);
  EXPECT_EQ(recorded.frame(2).positions, states_[1].x);
  EXPECT_NEAR(recorded.frame(kFrames).deformed.at(0).row(1).mean(), 0.5 + 0.25 * 0.04, 1e-12) << "the centre of the box that rises";
}

TEST_F(RecordedWorld, HasTheWholeFramesOfARecordThatEndsEarly) {
  run({});
  std::filesystem::resize_file(folder() / "record.bin", std::filesystem::file_size(folder() / "record.bin") - 1);
  const RecordedRun recorded(folder());
  EXPECT_EQ(recorded.frames(), kFrames - 1);
  EXPECT_THAT(recorded.missing(), HasSubstr("ends after frame 2 of 3"));
  EXPECT_EQ(recorded.frame(2).positions, states_[1].x);
}

TEST_F(RecordedWorld, DoesNotTakeTheRecordOfAnotherRun) {
  run({});
  const std::filesystem::path other = scratch_ / "other.bin";
  std::filesystem::rename(folder() / "record.bin", other);
  states_.clear();
  run({.materials = {{"cloth", "silk"}}});
  std::filesystem::rename(other, folder() / "record.bin");
  try {
    const RecordedRun recorded(folder());
    FAIL() << "shows " << recorded.frames();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is the record of another run"));
  }
}

TEST_F(RecordedWorld, WithNothingToShowIsRefused) {
  run({.write_record = false, .formats = {}});
  try {
    const RecordedRun recorded(folder());
    FAIL() << "shows " << recorded.frames();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("neither record.bin nor OBJ files"));
  }
}

// A frame of a particle is 6 doubles of the state and a byte; the model is written once.
TEST(RecordSize, IsAtMostAFifthMoreThanPositionsAndVelocities) {
  NetworkBuilder builder;
  BodyShape cloth = make_cloth({.size = {1.0, 1.0}, .resolution = {33, 33}}, testing::kSoft);
  set_total_mass(cloth, 1.0);
  builder.add_body("cloth", cloth);
  Simulator simulator(builder.build(), {.step = 0.005});
  const ScratchFolder scratch;
  constexpr int kManyFrames = 30;  // a second
  RunOutput output(OutputFolder(scratch / "out", false), {.frames = kManyFrames, .formats = {}}, simulator);
  FrameRunner runner(simulator);
  for (int frame = 1; frame <= kManyFrames; ++frame) {
    output.write_frame(simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
  }
  output.flush();
  const double states = kManyFrames * 33.0 * 33.0 * 6.0 * sizeof(double);
  EXPECT_LE(static_cast<double>(std::filesystem::file_size(scratch / "out/record.bin")), 1.2 * states);
}

}  // namespace
}  // namespace sprung
