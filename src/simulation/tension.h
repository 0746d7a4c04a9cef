// The tension of springs.
#pragma once

#include "simulation/simulator.h"

namespace sprung {

/// The tension of each spring [N], negative if it pushes: k_s (|s| - d) plus k_d times the rate of its length, at the present
/// state, plus the mean pull of the stretch limit, which needs SimulatorSettings::record_forces (see Simulator::limit_tensions).
/// Tethers are no springs: what they carry is missing.
[[nodiscard]] Scalars spring_tensions(const Simulator& simulator);

}  // namespace sprung
