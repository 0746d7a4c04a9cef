#include "scene/step_choice/many_steps.h"

#include "base/format.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

namespace sprung {
namespace {

constexpr int kManySteps = 1000;

// If a spring or angle bend bounds the step, its response rate times the step is about 1. Below this value, something else bounds
// the step.
constexpr double kLeastResponse = 0.05;

constexpr int kDigits = 3;

/// A cause of small steps. The response rate of particles is [1/s]: the square root of stiffness over mass, or damping over mass.
struct Demand {
  double rate = 0.0;
  Index particle = 0;  ///< the lightest of the particles
  double constant = 0.0;
  std::string source{};
  const char* unit = "";
  const char* remedy = "";
};

/// The lightest particle that is not pinned.
Index lightest(const SpringNetwork& network, std::initializer_list<Index> particles) {
  return std::max(particles, [&](Index a, Index b) { return network.inverse_masses[a] < network.inverse_masses[b]; });
}

Demand demand_of_springs(const SpringNetwork& network, const std::vector<double>& constants, bool damp) {
  const Springs& springs = network.springs;
  Demand found{.unit = damp ? " N s/m damping" : " N/m", .remedy = damp ? "damping" : "stiffness"};
  for (Index s = 0; s < springs.count(); ++s) {
    const double per_mass = constants[s] * (network.inverse_masses[springs.first[s]] + network.inverse_masses[springs.second[s]]);
    const double rate = damp ? per_mass : std::sqrt(per_mass);
    if (!(rate > found.rate)) continue;
    found.rate = rate;
    found.particle = lightest(network, {springs.first[s], springs.second[s]});
    found.constant = constants[s];
    found.source = std::string(kSpringKindNames[static_cast<std::size_t>(springs.kind[s])]) + " springs";
  }
  return found;
}

// For bends in line: the angle changes by 1 / length times the displacement of an end, and by the sum of both times that of the
// middle.
Demand demand_of_bends(const SpringNetwork& network, const std::vector<double>& constants, bool damp) {
  const AngleBends& bends = network.angle_bends;
  Demand found{.source = "angle bends", .unit = damp ? " N m s damping" : " N m", .remedy = damp ? "damping" : "stiffness"};
  for (Index e = 0; e < bends.count(); ++e) {
    const double before = 1.0 / bends.length_before[e];
    const double after = 1.0 / bends.length_after[e];
    const double per_mass = constants[e] * (before * before * network.inverse_masses[bends.before[e]] +
                                            (before + after) * (before + after) * network.inverse_masses[bends.middle[e]] +
                                            after * after * network.inverse_masses[bends.after[e]]);
    const double rate = damp ? per_mass : std::sqrt(per_mass);
    if (!(rate > found.rate)) continue;
    found.rate = rate;
    found.particle = lightest(network, {bends.before[e], bends.middle[e], bends.after[e]});
    found.constant = constants[e];
  }
  return found;
}

std::string reason(const SpringNetwork& network, double step) {
  const Demand largest = std::max(
      {demand_of_springs(network, network.springs.stiffness, false), demand_of_springs(network, network.springs.damping, true),
       demand_of_bends(network, network.angle_bends.stiffness, false), demand_of_bends(network, network.angle_bends.damping, true)},
      [](const Demand& a, const Demand& b) { return a.rate < b.rate; });
  if (largest.rate * step < kLeastResponse) return "penalty contact or air drag requires that; less of it";
  return "body \"" + network.body_of(largest.particle).name + "\" has " + largest.source + " of " +
         format_number(largest.constant, kDigits) + largest.unit + " at particles of " +
         format_number(network.masses[largest.particle], kDigits) + " kg; less " + largest.remedy + ", more mass";
}

}  // namespace

std::optional<std::string> many_steps_warning(const Scene& scene, const SpringNetwork& network, const StepChoice& choice,
                                              bool by_passes) {
  if (choice.steps_per_frame <= kManySteps) return std::nullopt;
  const std::string steps = "\"step\": \"auto\" takes " + std::to_string(choice.steps_per_frame) + " steps of " +
                            format_number(choice.step, kDigits) + " s a frame: ";
  if (by_passes) {
    return steps +
           "passes of the stretch limit require that; more \"iterations\", \"tethers\": true or \"solver\": \"newton\" needs fewer "
           "steps";
  }
  if (std::holds_alternative<ExplicitEulerSettings>(scene.settings.integrator)) {
    return steps + "explicit Euler gains energy in larger steps; \"symplectic_euler\" does not";
  }
  return steps + reason(network, choice.step) + " or \"implicit_euler\" needs fewer steps";
}

}  // namespace sprung
