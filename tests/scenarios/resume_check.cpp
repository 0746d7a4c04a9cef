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

constexpr int kComparedFrames = 3;

const ::testing::TestInfo& current_test() { return *::testing::UnitTest::GetInstance()->current_test_info(); }

/// The number of the run in its test.
int number_of_run() {
  static std::map<const ::testing::TestInfo*, int> runs;
  return ++runs[&current_test()];
}

bool are_equal(const Simulator& a, const Simulator& b) { return a.positions() == b.positions() && a.state().v == b.state().v; }

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
  simulator.restore(simulator.state());  // clears caches, as each run does at some frames
  SimulationState state;
  from_bytes(to_bytes(simulator.state()), state);
  EXPECT_TRUE(state == simulator.state()) << "the bytes of the state in frame " << begin_ << " do not hold all of it";
  resumed_ = std::make_unique<Simulator>(simulator);
  resumed_->restore(state);
}

void ResumeCheck::look(int frame, const Simulator& simulator) {
  if (!resumed_ || frame >= begin_ + kComparedFrames || first_different_ != 0) return;
  try {
    do {
      resumed_->step();
    } while (resumed_->state().step_in_frame != 0);
    if (are_equal(*resumed_, simulator)) return;
  } catch (const StepError&) {
  }
  first_different_ = frame;
}

void ResumeCheck::judge() const {
  EXPECT_EQ(first_different_, 0) << "resumed in frame " << begin_ << ", the run differs in this frame";
}

}  // namespace sprung::testing
