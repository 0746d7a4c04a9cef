#include "scene/many_steps.h"

#include "base/format.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

constexpr int kManySteps = 1000;

// Springs ask for steps of about the time in which their particles answer; what answers in less than this part of it is not theirs.
constexpr double kLeastPart = 0.05;

constexpr int kDigits = 3;

/// The spring whose particles answer fastest to what it has per metre, or per metre per second.
struct Fastest {
  Index spring = 0;
  double rate = 0.0;  ///< `of` (1/m_1 + 1/m_2)
};

Fastest fastest(const SpringNetwork& network, const std::vector<double>& of) {
  const Springs& springs = network.springs;
  Fastest found;
  for (Index s = 0; s < springs.count(); ++s) {
    const double rate = of[s] * (network.inverse_masses[springs.first[s]] + network.inverse_masses[springs.second[s]]);
    if (rate > found.rate) found = {s, rate};
  }
  return found;
}

std::string describe(const SpringNetwork& network, Index spring, double constant, const char* unit) {
  const Springs& springs = network.springs;
  const double mass = std::min(network.masses[springs.first[spring]], network.masses[springs.second[spring]]);
  return "body \"" + network.body_of(springs.first[spring]).name + "\" has " +
         kSpringKindNames[static_cast<std::size_t>(springs.kind[spring])] + " springs of " + format_number(constant, kDigits) +
         unit + " at particles of " + format_number(mass, kDigits) + " kg";
}

std::string reason(const SpringNetwork& network, double step) {
  const Fastest stiff = fastest(network, network.springs.stiffness);
  const Fastest damped = fastest(network, network.springs.damping);
  const double frequency = std::sqrt(stiff.rate);
  if (std::max(frequency, damped.rate) * step < kLeastPart)
    return "bends, penalty contact or air drag ask for that; less of them needs";
  if (damped.rate > frequency) {
    return describe(network, damped.spring, network.springs.damping[damped.spring], " N s/m damping") +
           "; less damping or more mass needs";
  }
  return describe(network, stiff.spring, network.springs.stiffness[stiff.spring], " N/m") + "; less stiffness or more mass needs";
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
