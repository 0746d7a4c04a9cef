#include "simulation/reaction_record.h"

#include <algorithm>
#include <string>

namespace sprung {
namespace {

std::string pin_name(const SpringNetwork& network, Index particle, Index pin) {
  if (pin != kFixedInPlace) return network.pins[static_cast<std::size_t>(pin)].name;
  const Body& body = network.body_of(particle);
  return body.name + ".particles[" + std::to_string(particle - body.first_particle) + "]";
}

}  // namespace

void collect_reactions(const SpringNetwork& network, const Activity& activity, SimulationState& state) {
  if (!state.impulses.on()) return;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!activity.is_pinned(i)) continue;
    const std::string name = pin_name(network, i, activity.pin_of[i]);
    Vector3& impulse = state.reactions.impulses.try_emplace(name, Vector3::Zero()).first->second;
    impulse -= state.impulses.on_pinned.col(i);
  }
  state.impulses.on_pinned.setZero();
}

std::vector<Reaction> mean_reactions(const SpringNetwork& network, const SimulationState& state, double duration) {
  SimulationState all;
  all.impulses = state.impulses;
  all.reactions = state.reactions;
  collect_reactions(network, network.activity, all);
  std::vector<Reaction> reactions;
  const auto append = [&](const std::string& name) {
    const auto found = all.reactions.impulses.find(name);
    const bool acted = found != all.reactions.impulses.end() && duration > 0.0;
    reactions.push_back({name, acted ? Vector3(found->second / duration) : Vector3(Vector3::Zero())});
  };
  for (const Pin& pin : network.pins) append(pin.name);
  for (const auto& [name, impulse] : all.reactions.impulses) {
    const auto is_it = [&](const auto& named) { return named.name == name; };
    if (std::ranges::none_of(network.pins, is_it) && std::ranges::none_of(network.attachments, is_it)) append(name);
  }
  for (const Attachment& attachment : network.attachments) append(attachment.name);
  return reactions;
}

}  // namespace sprung
