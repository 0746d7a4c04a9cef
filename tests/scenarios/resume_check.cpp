#include "scenarios/resume_check.h"

#include "base/error.h"
#include "base/test_seed.h"
#include "collision/sample_meshes.h"
#include "dynamics/state/state_members.h"
#include "simulation/checkpoint.h"
#include "simulation/diagnostics.h"

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

}  // namespace

ResumeCheck::ResumeCheck(int frames) {
  const std::string run = std::string(current_test().name()) + std::to_string(number_of_run());
  test::Random random(test::seeded(std::hash<std::string>{}(run)));
  begin_ = 2 + random.below(std::max(1, frames - kComparedFrames));
  fraction_ = random.between(0.0, 1.0);
}

void ResumeCheck::begin(int frame, Simulator& simulator, StepReport& report) {
  if (resumed_) compare(frame, simulator);
  if (frame != begin_) return;
  const int steps = static_cast<int>(fraction_ * simulator.settings().steps_per_frame);
  for (int step = 0; step < steps; ++step) report += simulator.step();
  resume(simulator);
}

void ResumeCheck::resume(const Simulator& simulator) {
  const Checkpoint before = simulator.checkpoint();
  Checkpoint after = before;
  from_bytes(to_bytes(before.state), after.state = {});
  EXPECT_TRUE(after.state == before.state) << "the bytes of the state do not hold all of it";
  resumed_.emplace(simulator);
  resumed_->restore(resumed_->state());  // without the caches of the copy
  resumed_->restore(after);
  EXPECT_TRUE(resumed_->checkpoint().caches == before.caches) << "the bytes of the caches do not hold all of them";
}

void ResumeCheck::compare(int frame, const Simulator& simulator) {
  try {
    FrameRunner(*resumed_).next_frame();
  } catch (const StepError&) {
    ADD_FAILURE() << "resumed in frame " << begin_ << ", the run diverges before frame " << frame;
    return resumed_.reset();
  }
  const bool is_same = resumed_->state() == simulator.state();
  EXPECT_TRUE(is_same) << "resumed in frame " << begin_ << ", the run differs in frame " << frame - 1;
  if (!is_same || frame == begin_ + kComparedFrames) resumed_.reset();
}

}  // namespace sprung::testing
