#include "scenarios/resume_check.h"

#include "base/error.h"
#include "base/test_seed.h"
#include "collision/sample_meshes.h"
#include "dynamics/state/state_members.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

namespace sprung::testing {
namespace {

constexpr int kComparedFrames = 2;

const ::testing::TestInfo& current_test() { return *::testing::UnitTest::GetInstance()->current_test_info(); }

/// The number of the run in its test.
int number_of_run() {
  static std::map<const ::testing::TestInfo*, int> runs;
  return ++runs[&current_test()];
}

void make_frame(Simulator& simulator) {
  do {
    simulator.step();
  } while (simulator.state().step_in_frame != 0);
}

}  // namespace

ResumeCheck::ResumeCheck(int frames) {
  const std::string run = std::string(current_test().name()) + std::to_string(number_of_run());
  test::Random random(test::seeded(std::hash<std::string>{}(run)));
  begin_ = 2 + random.below(std::max(1, frames - kComparedFrames));
  fraction_ = random.between(0.0, 1.0);
}

void ResumeCheck::begin(int frame, Simulator& simulator, StepReport& report) {
  if (frame != begin_) return;
  const int steps = static_cast<int>(fraction_ * simulator.settings().steps_per_frame);
  for (int step = 0; step < steps; ++step) report += simulator.step();
  try {
    compare(simulator);
  } catch (const StepError&) {
    return;  // the run will diverge too
  }
}

void ResumeCheck::compare(const Simulator& simulator) {
  Simulator original = simulator;  // the run keeps its caches
  make_frame(original);
  original.restore(original.state());
  SimulationState state;
  from_bytes(to_bytes(original.state()), state);
  EXPECT_TRUE(state == original.state()) << "the bytes of the state do not hold all of it";
  Simulator resumed = simulator;
  resumed.restore(state);
  for (int frame = 0; frame < kComparedFrames; ++frame) {
    make_frame(original);
    make_frame(resumed);
    if (resumed.state() == original.state()) continue;
    ADD_FAILURE() << "resumed after frame " << begin_ << ", the run differs " << frame + 1 << " frames later";
    return;
  }
}

}  // namespace sprung::testing
