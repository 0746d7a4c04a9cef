// The impulses that a pass of the stretch limit gives to springs and pins.
#pragma once

#include "dynamics/state/recorded_impulses.h"
#include "dynamics/stretch_limit/stretch_kernel.h"
#include "network/model/spring_network.h"

namespace sprung {

/// Springs of a batch share no particle, so each free end shows what its spring gave it.
class BatchRecorder {
 public:
  /// For one pass. Keeps references to both.
  BatchRecorder(const SpringNetwork& network, const SpringBatches& batches)
      : network_(network), batches_(batches), momenta_(Points::Zero(3, batches.count())) {}

  /// Calls `project_range` for one batch of a range after the other, which gives the same bits as for all at once. Thread-safe for
  /// different batches.
  template <class ProjectRange>
  SquaredLengths project(const BatchRange& batch_range, const Points& positions, const ProjectRange& project_range) {
    SquaredLengths measured;
    for (Index b = batch_range.begin; b < batch_range.end; ++b) {
      note_ends(batches_.batch[b], positions);
      measured.include(project_range({b, b + 1}));
      take_momenta(batches_.batch[b], positions);
    }
    return measured;
  }

  /// Requires the positions after the pass. Not thread-safe: springs share pins.
  void write_to(const ImpulseRecorder& recorder, const Points& positions) const;

 private:
  [[nodiscard]] bool shows_first(Index s) const { return !network_.is_fixed(batches_.first[s]); }
  [[nodiscard]] Index shown(Index s) const { return shows_first(s) ? batches_.first[s] : batches_.second[s]; }
  void note_ends(const SpringBatches::Batch& batch, const Points& positions);
  void take_momenta(const SpringBatches::Batch& batch, const Points& positions);

  const SpringNetwork& network_;
  const SpringBatches& batches_;
  Points momenta_;  ///< that limited springs gave to the ends that show it, their first free ones [kg m], 3 x springs; positions of
                    ///< these ends [m] while their batch is projected
};

}  // namespace sprung
