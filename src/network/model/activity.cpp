#include "network/model/activity.h"

#include "network/model/spring_network.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

namespace sprung {

bool holds_at(const Pin& pin, double time) { return pin.from < time && !(pin.until < time); }

bool has_moving_pin(const std::vector<Pin>& pins) { return std::ranges::any_of(pins, &Pin::moves); }

bool hold_together(const Pin& a, const Pin& b) { return a.from < b.until && b.from < a.until; }

std::vector<double> pin_changes(const std::vector<Pin>& pins) {
  std::set<double> times;
  for (const Pin& pin : pins) {
    if (pin.from > 0.0) times.insert(pin.from);
    if (std::isfinite(pin.until)) times.insert(pin.until);
  }
  return {times.begin(), times.end()};
}

Activity all_free(const SpringNetwork& network) {
  return {.phases = std::vector<PinPhase>(network.pins.size(), PinPhase::waiting),
          .pin_of = std::vector<Index>(static_cast<std::size_t>(network.particle_count()), kNone)};
}

bool have_pins_changed(const std::vector<Pin>& pins, const Activity& activity, double time) {
  for (std::size_t p = 0; p < pins.size(); ++p) {
    if (activity.phases[p] == PinPhase::holding && pins[p].until < time) return true;
    if (activity.phases[p] == PinPhase::waiting && pins[p].from < time) return true;
  }
  return false;
}

void change_pins(const std::vector<Pin>& pins, double time, Activity& activity) {
  for (std::size_t p = 0; p < pins.size(); ++p) {
    if (!(pins[p].until < time)) continue;
    activity.phases[p] = PinPhase::over;
    for (const Index i : pins[p].particles) {
      if (activity.pin_of[i] == static_cast<Index>(p)) activity.pin_of[i] = kNone;
    }
  }
  for (std::size_t p = 0; p < pins.size(); ++p) {
    if (activity.phases[p] != PinPhase::waiting || !(pins[p].from < time)) continue;
    activity.phases[p] = PinPhase::holding;
    for (const Index i : pins[p].particles) {
      if (!activity.is_pinned(i)) activity.pin_of[i] = static_cast<Index>(p);
    }
  }
}

Activity first_activity(const SpringNetwork& network) {
  Activity activity = all_free(network);
  change_pins(network.pins, std::numeric_limits<double>::min(), activity);
  return activity;
}

std::vector<Index> held_particles(const SpringNetwork& network, std::size_t pin) {
  std::vector<Index> held;
  std::ranges::copy_if(network.pins[pin].particles, std::back_inserter(held),
                       [&](Index i) { return network.activity.pin_of[i] == static_cast<Index>(pin); });
  return held;
}

void set_activity(Activity activity, SpringNetwork& network) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    const bool is_free = !activity.is_pinned(i) && !activity.is_asleep(i);
    network.inverse_masses[i] = is_free ? 1.0 / network.masses[i] : 0.0;
  }
  network.activity = std::move(activity);
}

bool is_asleep(const SpringNetwork& network, const Body& body) {
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    if (!network.is_asleep(i)) return false;
  }
  return true;
}

SpringNetwork freest(SpringNetwork network) {
  Activity activity = network.activity;
  for (Index& pin : activity.pin_of) {
    if (pin != kNone && !network.pins[static_cast<std::size_t>(pin)].holds_always()) pin = kNone;
  }
  set_activity(std::move(activity), network);
  return network;
}

}  // namespace sprung
