#include "output/forces_csv.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

TEST(ForcesCsv, ColumnsAreThoseOfTheContract) { EXPECT_EQ(forces_csv_head(), "frame,time,name,force_x,force_y,force_z\n"); }

TEST(ForcesCsv, EachForceHasARowOfTheShortestNumbersInTheGivenOrder) {
  const std::vector<Reaction> reactions{{"banner.pins[1]", {1.0 / 3.0, -2.5, 0.0}}, {"banner.pins[0]", {0.0, 1e-20, 3.0}}};
  EXPECT_EQ(forces_csv_rows(12, 0.1, reactions),
            "12,0.1,banner.pins[1],0.3333333333333333,-2.5,0\n12,0.1,banner.pins[0],0,1e-20,3\n");
}

TEST(ForcesCsv, AFrameWithoutForcesHasNoRow) { EXPECT_EQ(forces_csv_rows(1, 0.0, {}), ""); }

}  // namespace
}  // namespace sprung
