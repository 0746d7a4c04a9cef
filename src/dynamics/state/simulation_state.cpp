#include "dynamics/state/simulation_state.h"

#include "dynamics/state/state_bytes.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace sprung {

bool Steering::operator==(const Steering& other) const {
  return pins == other.pins && obstacles == other.obstacles && std::ranges::equal(added_pins, other.added_pins, are_alike);
}

bool SimulationState::operator==(const SimulationState& other) const {
  const auto bytes = [](const SimulationState& state) {
    std::string all;
    StateBytes([&](const void* data, std::size_t size) { all.append(static_cast<const char*>(data), size); }).write(state);
    return all;
  };
  return bytes(*this) == bytes(other);
}

std::uint64_t hash(const SimulationState& state) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  StateBytes([&](const void* data, std::size_t size) {
    for (const char byte : std::string_view(static_cast<const char*>(data), size)) {
      hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
    }
  }).write(state);
  return hash;
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
