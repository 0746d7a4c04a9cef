// What a page shows of a simulator.
#pragma once

#include "simulation/simulator.h"
#include "viewer/protocol/message.h"

#include <string>

namespace sprung {

[[nodiscard]] Topology topology_of(const Simulator& simulator);
[[nodiscard]] FrameState state_of(const Simulator& simulator);
/// The type of the integrator, as in a scene.
[[nodiscard]] std::string integrator_name(const Simulator& simulator);
/// All but the times and the particles without an admissible position.
[[nodiscard]] FrameNumbers numbers_of(const Simulator& simulator);

}  // namespace sprung
