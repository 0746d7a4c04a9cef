#include "scene/step_choice.h"

#include "base/format.h"
#include "scene/frame_steps.h"
#include "simulation/step_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace sprung {
namespace {

double largest_auto_step(const Scene& scene, const SpringNetwork& network, const SpectralBounds& bounds, double largest_stable) {
  double largest = std::min(kStablePart * largest_stable, step_for_growth_time(scene.settings.integrator, bounds, scene.duration));
  const bool implicit = std::holds_alternative<ImplicitEulerSettings>(scene.settings.integrator);
  if (!std::isfinite(largest) && !implicit) largest = kLargestAutoStep;
  if (!scene.settings.stretch_limit) return largest;
  const StretchLimit limit(network, *scene.settings.stretch_limit);
  return std::min(largest, limit.suggested_step(scene.settings.gravity.norm()));
}

std::string advice_for_unstable(const Scene& scene, double largest_stable) {
  if (const auto steps = fewest_steps_per_frame(scene.frame_rate, largest_stable)) {
    return "use at most " + format_number(step_of(scene.frame_rate, *steps)) + " or \"auto\"";
  }
  return "use \"auto\"";
}

std::string advice_for_too_many_steps(const Scene& scene) {
  const bool gains_energy = std::holds_alternative<ExplicitEulerSettings>(scene.settings.integrator);
  return std::string(gains_energy ? "use \"symplectic_euler\", which does not gain energy at any step, " : "use ") +
         "less stiffness, more mass, or a higher frame_rate";
}

bool may_be_halved(const SimulatorSettings& settings, const SpringNetwork& network) {
  const auto* verlet = std::get_if<VerletSettings>(&settings.integrator);
  const bool damps_steps = verlet != nullptr && verlet->damping > 0.0;
  return !damps_steps && settings.stretch_limit && StretchLimit(network, *settings.stretch_limit).bears_smaller_steps();
}

}  // namespace

StepChoice choose_step(const Scene& scene, const SpringNetwork& network, std::vector<Problem>& problems) {
  const SpectralBounds bounds = simulation_bounds(network, scene.settings, !scene.obstacles.empty());
  StepChoice choice;
  choice.largest_stable = largest_stable_step(scene.settings.integrator, bounds);
  if (scene.step) {
    choice.step = *scene.step;
    choice.steps_per_frame = steps_per_frame(scene.frame_rate, choice.step).value_or(1);
    if (is_unstable(choice.step, choice.largest_stable) && scene.settings.stability == StabilityCheck::refuse) {
      problems.push_back(unstable_step(choice.step, choice.largest_stable, advice_for_unstable(scene, choice.largest_stable)));
      problems.back().file = scene.file.string();
    }
    return choice;
  }
  const double largest = largest_auto_step(scene, network, bounds, choice.largest_stable);
  if (const auto steps = fewest_steps_per_frame(scene.frame_rate, largest)) {
    choice.steps_per_frame = *steps;
    choice.step = step_of(scene.frame_rate, *steps);
    choice.most_halvings = may_be_halved(scene.settings, network) ? kAutoHalvings : 0;
  } else {
    problems.push_back({scene.file.string(), "step", "\"auto\"",
                        "must be at most " + format_upper_bound(largest) + " s, which is too many steps a frame",
                        advice_for_too_many_steps(scene)});
  }
  return choice;
}

}  // namespace sprung
