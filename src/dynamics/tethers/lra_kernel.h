// Projection of particles onto the reach of their pins: the hot loop of Tethers.
#pragma once

#include "base/kernel.h"
#include "base/types.h"

namespace sprung {

/// Tethers of consecutive particles. Tether + i holds particle + i, by one pin or by consecutive ones.
struct LraRun {
  Index particle;
  Index pin;
  Index tether;
  Index count;
  bool one_pin;  ///< otherwise by pin + i
};

/// Moves particles that are farther from their pins than `lengths` [m] allow towards them; `positions` holds 3 numbers a particle
/// [m].
void project_tethers_narrow(const LraRun& run, const double* lengths, double* positions);

/// The same bits, with twice as many lanes. Requires has_wide_lanes().
void project_tethers_wide(const LraRun& run, const double* lengths, double* positions);

/// Whichever the machine has.
inline void project_tethers(const LraRun& run, const double* lengths, double* positions) {
  (has_wide_lanes() ? project_tethers_wide : project_tethers_narrow)(run, lengths, positions);
}

}  // namespace sprung
