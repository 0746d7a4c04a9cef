#include "scenarios/resume_check.h"

#include "base/error.h"
#include "base/test_seed.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>

namespace sprung::testing {
namespace {

constexpr int kComparedFrames = 3;

std::string name_of_test() {
  const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
  return std::string(test.test_suite_name()) + "." + test.name();
}

bool is_known_to_differ(const std::string& test) {
  std::ifstream file(SPRUNG_SOURCE_DIR "/tests/scenarios/known_resumes.txt");
  for (std::string line; std::getline(file, line);) {
    if (line == test) return true;
  }
  return false;
}

/// Fails at the end of a test of the list in which no run differed.
class ListShrinks : public ::testing::EmptyTestEventListener {
 public:
  ListShrinks() { ::testing::UnitTest::GetInstance()->listeners().Append(this); }

  /// Returns the number of the run in its test.
  int begin_run() { return ++runs_; }
  void note_difference() { any_differed_ = true; }

 private:
  void OnTestStart(const ::testing::TestInfo& /*test*/) override {
    runs_ = 0;
    any_differed_ = false;
  }
  void OnTestEnd(const ::testing::TestInfo& /*test*/) override {
    if (runs_ == 0 || any_differed_ || test::test_seed() != 0 || !is_known_to_differ(name_of_test())) return;
    ADD_FAILURE() << "remove from tests/scenarios/known_resumes.txt: " << name_of_test();
  }

  int runs_ = 0;
  bool any_differed_ = false;
};

ListShrinks& list() {
  static auto* const only = new ListShrinks;  // which gtest deletes
  return *only;
}

bool are_equal(const Simulator& a, const Simulator& b) { return a.positions() == b.positions() && a.state().v == b.state().v; }

}  // namespace

ResumeCheck::ResumeCheck(int frames, int steps_per_frame) : steps_per_frame_(steps_per_frame) {
  const std::string run = name_of_test() + std::to_string(list().begin_run());
  test::Random random(test::seeded(std::hash<std::string>{}(run)));
  begin_ = 1 + random.below(std::max(1, frames - kComparedFrames));
}

void ResumeCheck::look(int frame, const Simulator& simulator) {
  if (frame == begin_) {
    resumed_ = std::make_unique<Simulator>(
        Simulator::resume(simulator.network(), simulator.settings(), simulator.environment().obstacles(), simulator.state()));
  }
  if (frame <= begin_ || frame > begin_ + kComparedFrames || first_different_ != 0) return;
  try {
    for (int step = 0; step < steps_per_frame_; ++step) resumed_->step();
    if (are_equal(*resumed_, simulator)) return;
  } catch (const StepError&) {
  }
  first_different_ = frame;
}

void ResumeCheck::judge() const {
  if (first_different_ == 0) return;
  list().note_difference();
  if (test::test_seed() != 0 || is_known_to_differ(name_of_test())) return;  // the list holds for seed 0
  ADD_FAILURE() << "resumed after frame " << begin_ << ", the run differs in frame " << first_different_
                << " (tests/scenarios/known_resumes.txt): " << name_of_test();
}

}  // namespace sprung::testing
