// What `validate` says of scenes in mirror symmetry.
#pragma once

#include "simulation/simulator.h"

#include <string>

namespace sprung {

/// A row that tells how long contact and stretch limits keep the mirror symmetry of bodies, if these begin in one across x or z:
/// positions, velocities, masses and which particles are fixed. Empty if they do not.
[[nodiscard]] std::string symmetry_row(const Simulator& simulator);

}  // namespace sprung
