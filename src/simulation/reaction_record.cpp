#include "simulation/reaction_record.h"

namespace sprung {

void ReactionRecord::collect(const std::vector<Pin>& pins, RecordedImpulses& impulses) {
  if (!impulses.on()) return;
  for (const Pin& pin : pins) {
    Vector3& impulse = by_name_.try_emplace(pin.name, Vector3::Zero()).first->second;
    for (const Index particle : pin.particles) impulse -= impulses.on_pinned.col(particle);
  }
  impulses.on_pinned.setZero();
}

std::vector<Reaction> ReactionRecord::reactions(const SpringNetwork& network, const RecordedImpulses& impulses,
                                                double duration) const {
  ReactionRecord all = *this;
  RecordedImpulses latest = impulses;
  all.collect(network.pins, latest);
  std::vector<std::string> names = network.pin_names;
  for (const Attachment& attachment : network.attachments) names.push_back(attachment.name);
  std::vector<Reaction> reactions;
  for (const std::string& name : names) {
    const auto found = all.by_name_.find(name);
    const bool acted = found != all.by_name_.end() && duration > 0.0;
    reactions.push_back({name, acted ? Vector3(found->second / duration) : Vector3(Vector3::Zero())});
  }
  return reactions;
}

}  // namespace sprung
