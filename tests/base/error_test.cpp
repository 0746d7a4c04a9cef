#include "base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Problem, ReadsAsOneLine) {
  const Problem problem{"scene.json", "bodies.banner.mass", "-1", "must be greater than 0", "leave it out to use density"};
  EXPECT_EQ(to_string(problem), "scene.json: bodies.banner.mass = -1: must be greater than 0; leave it out to use density");
}

TEST(Problem, LeavesOutEmptyMembers) {
  EXPECT_EQ(to_string({.rule = "must be greater than 0"}), "must be greater than 0");
  EXPECT_EQ(to_string({.file = "a.obj", .rule = "does not exist"}), "a.obj: does not exist");
  EXPECT_EQ(to_string({.key = "mass", .rule = "is missing"}), "mass: is missing");
  EXPECT_EQ(to_string({.value = "-1", .rule = "must be positive"}), "-1: must be positive");
}

TEST(Problem, EscapesControlCharacters) {
  const std::string value("a\0b\x1B[2J\n", 8);
  EXPECT_EQ(to_string({.value = value, .rule = "is not JSON"}), "a\\x00b\\x1b[2J\\x0a: is not JSON");
}

TEST(InputError, ReportsEveryProblem) {
  const InputError error(std::vector<Problem>{{.key = "a", .rule = "is wrong"}, {.key = "b", .rule = "is missing"}});
  EXPECT_STREQ(error.what(), "a: is wrong\nb: is missing");
  EXPECT_EQ(error.problems().size(), 2U);
}

TEST(FileError, ReportsPathActionAndReason) {
  EXPECT_STREQ(FileError("write", "out/a.obj", "no space left").what(), "out/a.obj: cannot write: no space left");
}

TEST(StepError, ReportsStepTimeLocationAndRemedy) {
  const StepError error({12, 0.5, "rope", 3, 4, "a position is not finite", "use a step of at most 0.001 s", 0.001});
  for (const char* text : {"step 12", "0.5 s", "rope", "particle 3", "spring 4", "not finite", "at most 0.001 s"}) {
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(StepError, LeavesOutTheSpringIfThereIsNone) {
  EXPECT_THAT(StepError({1, 0.0, "rope", 3, kNone, "a position is not finite", "", {}}).what(), Not(HasSubstr("spring")));
}

}  // namespace
}  // namespace sprung
