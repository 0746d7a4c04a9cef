#include "scene/building/many_steps.h"

#include "base/format.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

namespace sprung {
namespace {

constexpr int kManySteps = 1000;

// Springs and bends ask for steps of about the time in which their particles answer; what answers in less than this part of it is
// not theirs.
constexpr double kLeastPart = 0.05;

constexpr int kDigits = 3;

/// What asks for small steps: how fast particles answer to it [1/s], as they do to springs in the root of their stiffness.
struct Demand {
  double rate = 0.0;
  Index particle = 0;  ///< one of those that answer
  double constant = 0.0;
  std::string of{};
  const char* unit = "";
  const char* remedy = "";
};

/// The one that is free and weighs least.
Index lightest(const SpringNetwork& network, std::initializer_list<Index> particles) {
  return std::max(particles, [&](Index a, Index b) { return network.inverse_masses[a] < network.inverse_masses[b]; });
}

Demand of_springs(const SpringNetwork& network, const std::vector<double>& constants, bool damp) {
  const Springs& springs = network.springs;
  Demand found{.unit = damp ? " N s/m damping" : " N/m", .remedy = damp ? "damping" : "stiffness"};
  for (Index s = 0; s < springs.count(); ++s) {
    const double per_mass = constants[s] * (network.inverse_masses[springs.first[s]] + network.inverse_masses[springs.second[s]]);
    const double rate = damp ? per_mass : std::sqrt(per_mass);
    if (!(rate > found.rate)) continue;
    found.rate = rate;
    found.particle = lightest(network, {springs.first[s], springs.second[s]});
    found.constant = constants[s];
    found.of = std::string(kSpringKindNames[static_cast<std::size_t>(springs.kind[s])]) + " springs";
  }
  return found;
}

// In line: the middle goes by as much as bends turn by about both bonds.
Demand of_bends(const SpringNetwork& network, const std::vector<double>& constants, bool damp) {
  const AngleBends& bends = network.angle_bends;
  Demand found{.of = "angle bends", .unit = damp ? " N m s damping" : " N m", .remedy = damp ? "damping" : "stiffness"};
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
  const Demand most =
      std::max({of_springs(network, network.springs.stiffness, false), of_springs(network, network.springs.damping, true),
                of_bends(network, network.angle_bends.stiffness, false), of_bends(network, network.angle_bends.damping, true)},
               [](const Demand& a, const Demand& b) { return a.rate < b.rate; });
  if (most.rate * step < kLeastPart) return "penalty contact or air drag ask for that; less of them needs";
  return "body \"" + network.body_of(most.particle).name + "\" has " + most.of + " of " + format_number(most.constant, kDigits) +
         most.unit + " at particles of " + format_number(network.masses[most.particle], kDigits) + " kg; less " + most.remedy +
         " or more mass needs";
}

}  // namespace

std::optional<std::string> many_steps_warning(const Scene& scene, const SpringNetwork& network, const StepChoice& choice,
                                              bool by_passes) {
  if (choice.steps_per_frame <= kManySteps) return std::nullopt;
  const std::string steps = "\"step\": \"auto\" takes " + std::to_string(choice.steps_per_frame) + " steps of " +
                            format_number(choice.step, kDigits) + " s a frame: ";
  if (by_passes) {
    return steps +
           "passes of the stretch limit ask for that; more \"iterations\", \"tethers\": true or \"solver\": \"newton\" need fewer";
  }
  if (std::holds_alternative<ExplicitEulerSettings>(scene.settings.integrator)) {
    return steps + "explicit Euler gains energy in larger ones; \"symplectic_euler\" does not";
  }
  return steps + reason(network, choice.step) + " fewer, and so does \"implicit_euler\"";
}

}  // namespace sprung
