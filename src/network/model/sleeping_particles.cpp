#include "network/model/sleeping_particles.h"

#include <algorithm>
#include <utility>

namespace sprung {

void set_asleep(std::vector<char> asleep, SpringNetwork& network) {
  if (std::ranges::count(asleep, 0) == static_cast<std::ptrdiff_t>(asleep.size())) asleep.clear();
  for (Index i = 0; i < network.particle_count(); ++i) {
    const bool sleeps = !asleep.empty() && asleep[i] != 0;
    if (sleeps != network.is_asleep(i)) network.inverse_masses[i] = sleeps ? 0.0 : 1.0 / network.masses[i];
  }
  network.asleep = std::move(asleep);
  for (const Pin& pin : network.pins) {
    for (const Index particle : pin.particles) network.inverse_masses[particle] = 0.0;
  }
}

SpringNetwork awake(SpringNetwork network) {
  set_asleep({}, network);
  return network;
}

bool is_asleep(const SpringNetwork& network, const Body& body) {
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    if (!network.is_asleep(i)) return false;
  }
  return true;
}

}  // namespace sprung
