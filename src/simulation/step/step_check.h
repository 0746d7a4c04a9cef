// What a simulation is checked for before it begins, and what is advised when it diverged all the same.
#pragma once

#include "base/error.h"
#include "dynamics/integrators/spectral_bounds.h"
#include "dynamics/integrators/stable_step.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

/// `spectral_bounds` of the network with its air drag and, when there are obstacles, its penalty contact.
[[nodiscard]] SpectralBounds simulation_bounds(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles);

/// How the simulation uses its stretch limit.
[[nodiscard]] LimitUse limit_use(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles);

/// The largest step that is advised, and that "auto" uses [s]: 0.9 of the largest stable one, no larger than the resonant one, and
/// such that a bounce by penalty contact takes three.
[[nodiscard]] double advised_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Whether a step is beyond the largest stable one by more than rounding.
[[nodiscard]] bool is_unstable(double step, double largest_stable);

/// The problem of a step that is beyond the largest stable one; `advice` is what to use instead.
[[nodiscard]] Problem unstable_step(double step, double largest_stable, const std::string& advice);

/// Throws InputError for a step that is not positive, or beyond the largest stable one unless `settings.stability` is warn. Returns
/// what the user should be warned of.
std::vector<std::string> check_step(const SimulatorSettings& settings, const SpectralBounds& bounds);

/// What to change when a simulation with these settings diverged.
[[nodiscard]] std::string divergence_remedy(const SimulatorSettings& settings, const SpectralBounds& bounds);

}  // namespace sprung
