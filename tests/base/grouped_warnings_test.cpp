#include "base/grouped_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using testing::ElementsAre;

TEST(GroupedWarnings, EqualTextsAreToldOnceWithTheirNames) {
  GroupedWarnings warnings("body", "bodies");
  EXPECT_THAT(warnings.lines(), ElementsAre());
  warnings.add("a", "hangs");
  EXPECT_THAT(warnings.lines(), ElementsAre("body \"a\": hangs"));
  warnings.add("b", "falls");
  warnings.add("b", "hangs");
  EXPECT_THAT(warnings.lines(), ElementsAre("bodies \"a\" and \"b\": hangs", "body \"b\": falls"));
  warnings.add("c", "hangs");
  warnings.add("d", "hangs");
  EXPECT_THAT(warnings.lines(), ElementsAre("bodies \"a\", \"b\" and 2 more: hangs", "body \"b\": falls"));
}

}  // namespace
}  // namespace sprung
