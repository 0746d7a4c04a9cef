// The impulses of pins and attachments since the last reading.
#pragma once

#include "dynamics/state/recorded_impulses.h"
#include "network/model/spring_network.h"
#include "simulation/reaction.h"

#include <map>
#include <string>
#include <vector>

namespace sprung {

/// A step records impulses by particle; before pins begin or end they are added up by pin. A pinned particle of mass m gains the
/// momentum m dv of its pin's motion, so its pin gives it m dv minus the impulses of all that acts on it: springs, gravity, drag,
/// the stretch limit, constraints and contact.
class ReactionRecord {
 public:
  /// Adds the recorded impulses on particles to their pins, and sets these to zero.
  void collect(const std::vector<Pin>& pins, RecordedImpulses& impulses);

  /// Adds the impulse [N s] of an attachment in a step on its first ends.
  void add(const std::string& attachment, const Vector3& impulse) {
    by_name_.try_emplace(attachment, Vector3::Zero()).first->second += impulse;
  }

  /// The mean forces over `duration` [s] of all pins of the network and then of its attachments, each in the order in which they
  /// were added, from what was collected and what the present pins have on top. Zero if the duration is zero.
  [[nodiscard]] std::vector<Reaction> reactions(const SpringNetwork& network, const RecordedImpulses& impulses,
                                                double duration) const;

  void reset() { by_name_.clear(); }

 private:
  std::map<std::string, Vector3> by_name_;  ///< impulses on the bodies [N s]
};

}  // namespace sprung
