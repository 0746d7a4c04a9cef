#include "simulation/reaction_record.h"

#include <string>

namespace sprung {

bool records_as(const SimulatorSettings& settings, const RecordedImpulses& record) {
  return settings.record_forces == record.on() && settings.record_contact_forces == record.has_contact();
}

void collect_reactions(const std::vector<Pin>& pins, const Activity& activity, SimulationState& state) {
  if (!state.impulses.on()) return;
  for (Index i = 0; i < state.impulses.on_pinned.cols(); ++i) {
    if (!activity.is_pinned(i)) continue;
    const std::string& name = pins[activity.pin_of[i]].name;
    Vector3& impulse = state.reactions.impulses.try_emplace(name, Vector3::Zero()).first->second;
    impulse -= state.impulses.on_pinned.col(i);
  }
  state.impulses.on_pinned.setZero();
}

std::vector<Reaction> mean_reactions(const SpringNetwork& network, const SimulationState& state, double duration) {
  SimulationState all;
  all.impulses = state.impulses;
  all.reactions = state.reactions;
  collect_reactions(network.pins, network.activity, all);
  std::vector<Reaction> reactions;
  const auto append = [&](const std::string& name) {
    const auto found = all.reactions.impulses.find(name);
    const bool acted = found != all.reactions.impulses.end() && duration > 0.0;
    reactions.push_back({name, acted ? Vector3(found->second / duration) : Vector3(Vector3::Zero())});
  };
  for (const Pin& pin : network.pins) append(pin.name);
  for (const Attachment& attachment : network.attachments) append(attachment.name);
  return reactions;
}

}  // namespace sprung
