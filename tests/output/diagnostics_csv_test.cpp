#include "output/diagnostics_csv.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

TEST(DiagnosticsCsv, ColumnsAreThoseOfTheContract) {
  EXPECT_EQ(csv_head(),
            "frame,time,kinetic_energy,elastic_energy,gravity_energy,max_stretch,contacts,min_distance,frame_ms,"
            "stretch_excess,truncated,infeasible,limit_solves,substeps,reason,contact_energy,inverted_cells\n");
}

TEST(DiagnosticsCsv, RowHoldsTheShortestNumbersInTheColumnsOrder) {
  const FrameDiagnostics frame{.frame = 12,
                               .time = 0.1,
                               .kinetic_energy = 1.0 / 3.0,
                               .elastic_energy = 2.0,
                               .gravity_energy = -3.5,
                               .contact_energy = 0.125,
                               .max_stretch = 1e-20,
                               .stretch_excess = 0.25,
                               .contacts = 4,
                               .min_distance = 0.005,
                               .truncated = 6,
                               .infeasible = 7,
                               .inverted_cells = 11,
                               .substeps = 10,
                               .reason = PlanReason::solver_trial,
                               .limit_solves = 9,
                               .frame_ms = 8.5};
  EXPECT_EQ(csv_row(frame), "12,0.1,0.3333333333333333,2,-3.5,1e-20,4,0.005,8.5,0.25,6,7,9,10,solver_trial,0.125,11\n");
}

TEST(DiagnosticsCsv, DistanceThatIsNotKnownIsEmpty) {
  FrameDiagnostics frame;
  frame.time = 0.5;
  EXPECT_EQ(csv_row(frame), "1,0.5,0,0,0,0,0,,0,0,0,0,0,0,first,0,0\n");
}

}  // namespace
}  // namespace sprung
