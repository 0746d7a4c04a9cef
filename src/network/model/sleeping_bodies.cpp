#include "network/model/sleeping_bodies.h"

#include <algorithm>

namespace sprung {

std::vector<char> asleep(const SpringNetwork& network) {
  std::vector<char> result;
  for (const Body& body : network.bodies) result.push_back(body.asleep ? 1 : 0);
  return result;
}

void set_asleep(const std::vector<char>& asleep, SpringNetwork& network) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    Body& body = network.bodies[b];
    const bool sleeps = asleep[b] != 0;
    if (sleeps == body.asleep) continue;
    body.asleep = sleeps;
    const auto range = Eigen::seqN(body.first_particle, body.particle_count);
    if (sleeps) {
      network.inverse_masses(range).setZero();
    } else {
      network.inverse_masses(range) = network.masses(range).cwiseInverse();
    }
  }
  for (const Pin& pin : network.pins) {
    for (const Index particle : pin.particles) network.inverse_masses[particle] = 0.0;
  }
}

SpringNetwork awake(SpringNetwork network) {
  set_asleep(std::vector<char>(network.bodies.size(), 0), network);
  return network;
}

}  // namespace sprung
