#include "network/model/pin_schedule.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace sprung {
namespace {

void free_particle(SpringNetwork& network, Index particle) { network.inverse_masses[particle] = 1.0 / network.masses[particle]; }

}  // namespace

bool holds_at(const Pin& pin, double time) { return pin.from < time && !(pin.until < time); }

bool has_moving_pin(const SpringNetwork& network) {
  return std::ranges::any_of(network.pins, &Pin::moves) || std::ranges::any_of(network.later_pins, &Pin::moves);
}

bool hold_together(const Pin& a, const Pin& b) { return a.from < b.until && b.from < a.until; }

bool have_pins_changed(const SpringNetwork& network, double time) {
  return std::ranges::any_of(network.pins, [&](const Pin& pin) { return pin.until < time; }) ||
         std::ranges::any_of(network.later_pins, [&](const Pin& pin) { return pin.from < time; });
}

void change_pins(SpringNetwork& network, double time) {
  std::erase_if(network.pins, [&](const Pin& pin) {
    if (!(pin.until < time)) return false;
    for (const Index particle : pin.particles) free_particle(network, particle);
    return true;
  });
  std::erase_if(network.later_pins, [&](Pin& pin) {
    if (!(pin.from < time)) return false;
    if (pin.until < time) return true;
    std::erase_if(pin.particles, [&](Index particle) { return network.is_pinned(particle); });
    for (const Index particle : pin.particles) network.inverse_masses[particle] = 0.0;
    if (!pin.particles.empty()) network.pins.push_back(std::move(pin));
    return true;
  });
}

std::vector<double> pin_changes(const SpringNetwork& network) {
  std::set<double> times;
  for (const std::vector<Pin>* pins : {&network.pins, &network.later_pins}) {
    for (const Pin& pin : *pins) {
      if (pin.from > 0.0) times.insert(pin.from);
      if (std::isfinite(pin.until)) times.insert(pin.until);
    }
  }
  return {times.begin(), times.end()};
}

SpringNetwork freest(SpringNetwork network) {
  for (const Pin& pin : network.pins) {
    if (pin.holds_always()) continue;
    for (const Index particle : pin.particles) free_particle(network, particle);
  }
  return network;
}

}  // namespace sprung
