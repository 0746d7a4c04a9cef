// A law of all constraints.
#pragma once

#include "base/parallel.h"
#include "dynamics/constraints/constraint.h"

#include <gtest/gtest.h>

namespace sprung::testing {

/// Expects that a pass from `start` [m], 3 x n, gives the same bits with one thread and with four.
inline void expect_same_bits(const Constraint& constraint, const Points& start) {
  Points alone = start;
  Points together = start;
  {
    const ThreadLimit one(1);
    constraint.project(start, alone, {});
  }
  const ThreadLimit four(4);
  constraint.project(start, together, {});
  EXPECT_NE(alone, start);
  EXPECT_EQ(alone, together);
}

}  // namespace sprung::testing
