// Long range attachments: particles stay within reach of their pins (Kim, Chentanez and Mueller-Fischer 2012).
#pragma once

#include "dynamics/tethers/lra_kernel.h"
#include "network/spring_network.h"

#include <vector>

namespace sprung {

/// Springs that are within their limits keep each particle within (1 + max_stretch) times its distance along them from each pin;
/// here from the nearest pin of each of the kMostTethers nearest groups.
/// Passes of projection hand that on from spring to spring; tethers know it at once. They pull, and never push.
class LongRangeAttachments {
 public:
  /// Tethers along springs of these kinds. Pins may move.
  LongRangeAttachments(const SpringNetwork& network, const std::vector<SpringKind>& kinds, double max_stretch);

  /// Moves each particle that is too far from a pin straight towards it, one pin after the other. Same bits for any number of
  /// threads.
  void project(Points& positions) const;

 private:
  std::vector<double> lengths_;  ///< allowed, of each tether [m]
  std::vector<LraRun> runs_;
  std::vector<Index> begin_;  ///< block b of particles holds runs [begin[b], begin[b + 1])
};

}  // namespace sprung
