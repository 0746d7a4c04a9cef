#include "dynamics/state/simulation_state.h"

#include "base/files/fingerprint.h"
#include "dynamics/state/state_members.h"
#include "network/model/spring_network.h"

#include <algorithm>

namespace sprung {

bool Steering::operator==(const Steering& other) const {
  return pins == other.pins && obstacles == other.obstacles && std::ranges::equal(added_pins, other.added_pins, are_alike);
}

bool SimulationState::operator==(const SimulationState& other) const { return to_bytes(*this) == to_bytes(other); }

std::uint64_t hash(const SimulationState& state) {
  Fingerprint fingerprint;
  BinaryWriter writer([&](const void* data, std::size_t size) { fingerprint.add({static_cast<const char*>(data), size}); });
  writer.write(state);
  return fingerprint.value();
}

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
