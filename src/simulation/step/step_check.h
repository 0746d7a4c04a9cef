// Checks of the step before a simulation starts, and the remedy if it diverges nevertheless. All name the same step to use instead.
#pragma once

#include "base/error.h"
#include "dynamics/integrators/spectral_bounds.h"
#include "dynamics/integrators/stable_step.h"
#include "simulation/settings/simulator_settings.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

class Force;
struct SpringNetwork;

/// The bounds of all forces, among them penalty contact if there are obstacles, and external ones. They hold for every set of pins
/// that are active together.
[[nodiscard]] SpectralBounds simulation_bounds(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles,
                                               const std::vector<std::shared_ptr<Force>>& external = {});

/// The number of calls of simulation_bounds in this process.
[[nodiscard]] std::int64_t bounds_count();

/// Properties of the simulation that the stretch limit depends on.
[[nodiscard]] LimitUse limit_use(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles);

/// The largest recommended step [s], which "auto" uses: at most 0.9 of the largest stable step, at most the resonant step, and
/// small enough that a bounce by penalty contact takes three steps. Dampers of materials act with the springs if the springs alone
/// would not permit a larger step, and apart from them otherwise.
[[nodiscard]] double advised_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Whether a simulation with this step integrates the dampers of materials apart from the other forces: the step is larger than
/// they permit otherwise.
[[nodiscard]] bool splits_dampers(const SimulatorSettings& settings, const SpectralBounds& bounds);

/// Whether a step exceeds the largest stable one by more than rounding [s].
[[nodiscard]] bool is_unstable(double step, double largest_stable);

/// The problem of settings.step, which is beyond the largest stable step. It names the force that bounds the step most, and a step
/// to use instead.
[[nodiscard]] Problem unstable_step(const SimulatorSettings& settings, const SpectralBounds& bounds);

/// Returns warnings about the step. Throws InputError if the step is not positive, or if it is beyond the largest stable one and
/// `settings.stability` is not warn.
std::vector<std::string> check_step(const SimulatorSettings& settings, const SpectralBounds& bounds);

/// Sets remedy and `smaller_step` of a divergence. The first rule that applies wins: (1) the scheme gains energy or the step
/// exceeds advised_step(): the advice of unstable_step(); (2) the failure has a remedy: it stays; (3) half of the step.
void set_divergence_remedy(const SimulatorSettings& settings, const SpectralBounds& bounds, StepFailure& failure);

}  // namespace sprung
