#include "dynamics/forces/material_dampers.h"

#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/spring_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace sprung {
namespace {

ElementConstants material_springs(const SpringNetwork& network) {
  const auto count = static_cast<std::size_t>(network.springs.count());
  ElementConstants constants{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  for_material_springs(network, [&](Index s) { constants.damping[s] = network.springs.damping[s]; });
  return constants;
}

ElementConstants material_bends(const SpringNetwork& network) {
  const ElementConstants all = constants_of_bends(network);
  const std::size_t count = all.damping.size();
  ElementConstants constants{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0), true};
  for_material_bends(network, [&](Index e) { constants.damping[e] = all.damping[e]; });
  return constants;
}

/// Row sums of M^-1 C [1/s]; no mode is damped faster than the largest of the particles that it moves. With the masses of pinned
/// particles, which may become free.
Scalars damping_rates(const SpringNetwork& network, const std::vector<LinearElement>& elements) {
  Scalars rates = Scalars::Zero(network.particle_count());
  for (const LinearElement& element : elements) {
    double sum = 0.0;
    for (const double weight : element.weights) sum += std::abs(weight);
    for (std::size_t k = 0; k < element.count; ++k) {
      rates[element.particles[k]] += element.damping * std::abs(element.weights[k]) * sum;
    }
  }
  return rates.cwiseQuotient(network.masses);
}

/// Each damper becomes weaker by the larger excess of its particles, so no row sum stays above `most`. `damper_of` is by element.
template <class DamperOf>
void weaken(const Scalars& rates, double most, const std::vector<LinearElement>& elements, const DamperOf& damper_of,
            std::vector<double>& damping) {
  std::vector<double> largest(damping.size(), most);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    double& rate = largest[damper_of(e)];
    for (std::size_t k = 0; k < elements[e].count; ++k) {
      if (elements[e].weights[k] != 0.0) rate = std::max(rate, rates[elements[e].particles[k]]);
    }
  }
  for (std::size_t d = 0; d < damping.size(); ++d) damping[d] *= most / largest[d];
}

}  // namespace

bool face_bends_damp_fast(const SpringNetwork& network, const Body& body) {
  constexpr double kFast = 0.1;
  if (body.face_bend_count == 0) return false;
  double fastest = 0.0;  // the square of a spring's frequency [1/s^2]
  const Springs& springs = network.springs;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const double per_mass = 1.0 / network.masses[springs.first[s]] + 1.0 / network.masses[springs.second[s]];
    fastest = std::max(fastest, springs.stiffness[s] * per_mass);
  }
  Scalars rates = Scalars::Zero(network.particle_count());  // row sums, times the mass
  const FaceBends& bends = network.face_bends;
  for (Index f = body.first_face_bend; f < body.first_face_bend + body.face_bend_count; ++f) {
    const BendStencil stencil = stencil_of(bends, network.hinges, f);
    for (const std::array<double, 6>& weights : weights_of(bends, network.hinges, f)) {
      double sum = 0.0;
      for (const double weight : weights) sum += std::abs(weight);
      for (std::size_t k = 0; k < weights.size(); ++k) rates[stencil.particles[k]] += bends.damping[f] * std::abs(weights[k]) * sum;
    }
  }
  const double longest_step = 2.0 / std::sqrt(fastest);
  return !(rates.cwiseQuotient(network.masses).maxCoeff() * longest_step <= kFast);
}

bool has_material_dampers(const SpringNetwork& network) {
  return std::ranges::any_of(network.bodies, [](const Body& body) {
    return std::ranges::any_of(body.has_material_dampers, [](bool has) { return has; });
  });
}

ElementConstants springs_without_material_dampers(const SpringNetwork& network) {
  ElementConstants constants{network.springs.stiffness, network.springs.damping};
  for_material_springs(network, [&](Index s) { constants.damping[s] = 0.0; });
  return constants;
}

ElementConstants bends_without_material_dampers(const SpringNetwork& network) {
  ElementConstants constants = constants_of_bends(network);
  for_material_bends(network, [&](Index e) { constants.damping[e] = 0.0; });
  return constants;
}

Forces material_dampers(const SpringNetwork& network, double most) {
  ElementConstants springs = material_springs(network);
  ElementConstants bends = material_bends(network);
  std::vector<LinearElement> of_springs;
  std::vector<LinearElement> of_bends;
  SpringForce(network, springs).append_elements(of_springs);
  BendingAngleForce(network, bends).append_elements(of_bends);
  const Scalars rates = damping_rates(network, of_springs) + damping_rates(network, of_bends);
  weaken(
      rates, most, of_springs, [](std::size_t e) { return e; }, springs.damping);
  const auto lines = static_cast<std::size_t>(network.angle_bends.count());
  weaken(
      rates, most, of_bends, [&](std::size_t e) { return e < lines ? e : lines + (e - lines) / 3; }, bends.damping);
  const auto any = [](const std::vector<double>& values) { return std::ranges::any_of(values, [](double c) { return c > 0.0; }); };
  Forces forces;
  if (any(springs.damping)) forces.push_back(std::make_unique<SpringForce>(network, std::move(springs)));
  if (any(bends.damping)) forces.push_back(std::make_unique<BendingAngleForce>(network, std::move(bends)));
  return forces;
}

}  // namespace sprung
