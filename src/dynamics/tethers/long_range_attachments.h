// Long range attachments: particles stay within reach of their pins (Kim, Chentanez and Mueller-Fischer 2012).
#pragma once

#include "dynamics/state/recorded_impulses.h"
#include "dynamics/tethers/lra_kernel.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Springs within their limits keep each particle within (1 + max_stretch) times its distance along the springs from each pin. A
/// tether enforces this bound directly, where passes propagate it from spring to spring. Each particle has tethers to the nearest
/// pin of each of its kMostTethers nearest groups of pins. Tethers pull and never push.
class LongRangeAttachments {
 public:
  /// Tethers along springs of these kinds. Pins may move.
  LongRangeAttachments(const SpringNetwork& network, const std::vector<SpringKind>& kinds, double max_stretch);

  /// Moves each particle that is too far from a pin straight towards it, one pin after the other. Gives the same bits for any
  /// number of threads.
  void project(Points& positions) const;

  /// The same bits. Records the impulses on pinned particles; `masses` [kg] are those of the particles.
  void project(Points& positions, const Scalars& masses, const ImpulseRecorder& recorder) const;

 private:
  std::vector<double> lengths_;  ///< allowed length of each tether [m]
  std::vector<LraRun> runs_;
  std::vector<Index> begin_;  ///< block b of particles holds runs [begin[b], begin[b + 1])
};

}  // namespace sprung
