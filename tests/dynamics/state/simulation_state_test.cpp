#include "dynamics/state/simulation_state.h"

#include "network/network_builder.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

TEST(SimulationState, BeginsWithTheNetwork) {
  NetworkBuilder builder;
  builder.add_particle(Vector3(1, 2, 3), 1.0, Vector3(4, 5, 6));
  const SpringNetwork network = builder.build();
  const SimulationState state = initial_state(network);
  EXPECT_EQ(state.step, 0);
  EXPECT_EQ(state.x, network.positions);
  EXPECT_EQ(state.v, network.velocities);
  EXPECT_EQ(state.x_previous, network.positions);
}

TEST(SimulationState, CountsStepsWithinFrames) {
  SimulationState state;
  state.steps_per_frame = 3;
  for (int step = 0; step < 7; ++step) count_step(state);
  EXPECT_EQ(state.step, 7);
  EXPECT_EQ(state.frame, 2);
  EXPECT_EQ(state.step_in_frame, 1);
  EXPECT_EQ(whole_steps(state), 7);
  state.substeps = 4;
  state.substep = 3;
  EXPECT_EQ(steps_done(state), 7.75);
}

}  // namespace
}  // namespace sprung
