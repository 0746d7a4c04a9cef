#include "simulation/step/step_check.h"

#include "base/format.h"
#include "dynamics/forces/pressure_force.h"
#include "network/model/pin_schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

// A bounce is half a period of the penalty spring. In three steps or more its energy error is below a tenth. In one or two steps
// the depth differs between entry and exit, and energy rises: a cloth of 0.9 J reached 12 J after two bounces, damped or not.
double step_for_penalty(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  if (bounds.penalty == 0.0 || std::holds_alternative<ImplicitEulerSettings>(settings)) {
    return std::numeric_limits<double>::infinity();
  }
  return 1.0 / std::sqrt(bounds.penalty);
}

bool grows_transversally(const IntegratorSettings& integrator, const SpectralBounds& bounds) {
  return std::holds_alternative<ExplicitEulerSettings>(integrator) && bounds.elastic > 0.0 && bounds.least_drag == 0.0;
}

SpectralBounds bounds_of(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles) {
  SpectralBounds bounds = spectral_bounds(network, settings.air_drag);
  if (has_obstacles && settings.contact.response == ContactSettings::Response::penalty) {
    // A penalty connects a particle to the fixed obstacle: it adds to the Laplacian's diagonal, and at most this to its
    // eigenvalues.
    const double largest_inverse_mass = network.inverse_masses.maxCoeff();
    bounds.penalty = settings.contact.stiffness * largest_inverse_mass;
    bounds.elastic += bounds.penalty;
    bounds.damping += settings.contact.damping * largest_inverse_mass;
  }
  if (has_pressure(network)) bounds.elastic += PressureForce(network).largest_eigenvalue();
  return bounds;
}

}  // namespace

SpectralBounds simulation_bounds(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles) {
  const bool change = !network.later_pins.empty() || !std::ranges::all_of(network.pins, &Pin::holds_always);
  return bounds_of(change ? freest(network) : network, settings, has_obstacles);
}

LimitUse limit_use(const SpringNetwork& network, const SimulatorSettings& settings, bool has_obstacles) {
  return {.may_collide = has_obstacles || bodies_may_collide(network),
          .takes_small_steps = !std::holds_alternative<ImplicitEulerSettings>(settings.integrator)};
}

double advised_step(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  constexpr double kStableFraction = 0.9;
  return std::min({kStableFraction * largest_stable_step(settings, bounds), resonant_step(settings, bounds),
                   step_for_penalty(settings, bounds)});
}

bool is_unstable(double step, double largest_stable) {
  constexpr double kRounding = 1.0 + 1.0e-9;  // the bound has a larger margin
  return step > kRounding * largest_stable;
}

Problem unstable_step(double step, double largest_stable, const std::string& advice) {
  return {.key = "step",
          .value = format_number(step),
          .rule = "is beyond the largest stable step, " + format_upper_bound(largest_stable) + " s",
          .remedy = advice + "; \"stability\": \"warn\" runs it nevertheless"};
}

std::vector<std::string> check_step(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  const double step = settings.step;
  if (!(step > 0.0) || !std::isfinite(step)) {
    throw InputError({.key = "step", .value = format_number(step), .rule = "must be a positive number of seconds"});
  }
  const double largest = largest_stable_step(settings.integrator, bounds);
  if (is_unstable(step, largest)) {
    const Problem problem = unstable_step(step, largest, "use at most that, or \"auto\"");
    if (settings.stability == StabilityCheck::refuse) throw InputError(problem);
    return {"step = " + problem.value + " " + problem.rule + ": the simulation is likely to diverge. Use a smaller step."};
  }
  const double growth = growth_time(settings.integrator, bounds, step);
  if (std::isfinite(growth)) {
    return {"explicit Euler gains energy at any step: the fastest mode of the springs grows by a factor of e every " +
            format_number(growth, 2) + " s. Use \"symplectic_euler\"."};
  }
  if (!grows_transversally(settings.integrator, bounds)) return {};
  return {
      "explicit Euler gains energy at any step: dampers compensate it along the springs, but not perpendicular to taut springs. "
      "Use \"symplectic_euler\"."};
}

std::string divergence_remedy(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  const double advised = advised_step(settings.integrator, bounds);
  if (settings.step > advised) return "use a step of at most " + format_number(advised, 2) + " s, or \"auto\"";
  if (std::isfinite(growth_time(settings.integrator, bounds, settings.step))) {
    return "explicit Euler gains energy at any step; use \"symplectic_euler\" or a step below " +
           format_number(0.1 * settings.step, 2) + " s";
  }
  return "use a step below " + format_number(0.5 * settings.step, 2) + " s, less stiffness, or slower motion";
}

}  // namespace sprung
