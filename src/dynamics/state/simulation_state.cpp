#include "dynamics/state/simulation_state.h"

#include "network/model/spring_network.h"

namespace sprung {

SimulationState initial_state(const SpringNetwork& network) {
  SimulationState state;
  state.x = network.positions;
  state.v = network.velocities;
  state.x_previous = network.positions;
  state.activity = network.activity;
  state.springs = initial_springs(network.springs);
  state.contact.slip.displacement.setZero(3, network.positions.cols());
  state.contact.slip.obstacle.assign(static_cast<std::size_t>(network.positions.cols()), kNone);
  state.limit.handovers.resize(network.bodies.size());
  return state;
}

}  // namespace sprung
