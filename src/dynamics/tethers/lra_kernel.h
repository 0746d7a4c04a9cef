// Projection of particles into the reach of their pins: the inner loop of LongRangeAttachments.
#pragma once

#include "base/machine/kernel.h"
#include "base/types.h"

namespace sprung {

/// Tethers of consecutive particles. Tether + i constrains particle + i by one common pin or by consecutive pins.
struct LraRun {
  Index particle;
  Index pin;
  Index tether;
  Index count;
  bool one_pin;  ///< all use the same pin; otherwise pin + i
};

/// Moves particles that are farther from their pins than `lengths` [m] towards them. `positions` [m] holds 3 numbers a particle.
void project_tethers_narrow(const LraRun& run, const double* lengths, double* positions);

/// The same bits with registers twice as wide. Requires has_wide_lanes().
void project_tethers_wide(const LraRun& run, const double* lengths, double* positions);

/// Chooses the version for this machine.
inline void project_tethers(const LraRun& run, const double* lengths, double* positions) {
  (has_wide_lanes() ? project_tethers_wide : project_tethers_narrow)(run, lengths, positions);
}

}  // namespace sprung
