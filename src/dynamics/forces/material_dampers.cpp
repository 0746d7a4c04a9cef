#include "dynamics/forces/material_dampers.h"

#include "dynamics/forces/angle_dampers.h"
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
  ElementConstants constants{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  for_material_bends(network, [&](Index e) { constants.damping[e] = all.damping[e]; });
  return constants;
}

double absolute_sum(const std::array<double, 6>& weights) {
  double sum = 0.0;
  for (const double weight : weights) sum += std::abs(weight);
  return sum;
}

/// Row sums of M^-1 C [1/s], which bound its eigenvalues (Gershgorin). Pinned particles count with their masses, as they may become
/// free.
Scalars damping_rates(const SpringNetwork& network, const std::vector<LinearElement>& elements) {
  Scalars rates = Scalars::Zero(network.particle_count());
  for (const LinearElement& element : elements) {
    const double sum = absolute_sum(element.weights);
    for (std::size_t k = 0; k < element.count; ++k) {
      rates[element.particles[k]] += element.damping * std::abs(element.weights[k]) * sum;
    }
  }
  return rates.cwiseQuotient(network.masses);
}

/// Divides each damping by the largest ratio of `rates` to `most` among its particles, if that exceeds 1. No row sum then exceeds
/// `most` [1/s]. `damper_of(e)` is the number of the damper of element e.
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
  // Slower dampers leave automatic steps stable as a part of the other forces: dt^2 l_K + 2 dt l_D <= 3.24 + 2 * 0.1 < 4.
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
      const double sum = absolute_sum(weights);
      for (std::size_t k = 0; k < weights.size(); ++k) rates[stencil.particles[k]] += bends.damping[f] * std::abs(weights[k]) * sum;
    }
  }
  const double longest_step = 2.0 / std::sqrt(fastest);  // one spring alone allows no longer one
  return !(rates.cwiseQuotient(network.masses).maxCoeff() * longest_step <= kFast);
}

bool has_material_dampers(const Body& body) {
  return std::ranges::any_of(body.has_material_dampers, [](bool has) { return has; });
}

bool has_material_dampers(const SpringNetwork& network) {
  return std::ranges::any_of(network.bodies, [](const Body& body) { return has_material_dampers(body); });
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
  const auto angles = static_cast<std::size_t>(network.angle_bends.count());
  weaken(
      rates, most, of_bends, [&](std::size_t e) { return e < angles ? e : angles + (e - angles) / 3; },  // 3 of each face bend
      bends.damping);
  const auto any = [](const std::vector<double>& values) { return std::ranges::any_of(values, [](double c) { return c > 0.0; }); };
  Forces forces;
  if (any(springs.damping)) forces.push_back(std::make_unique<SpringForce>(network, std::move(springs)));
  std::vector<double> of_angles(bends.damping.begin(), bends.damping.begin() + static_cast<std::ptrdiff_t>(angles));
  std::fill_n(bends.damping.begin(), angles, 0.0);
  if (any(of_angles)) forces.push_back(std::make_unique<AngleDampers>(network, std::move(of_angles)));
  if (any(bends.damping)) forces.push_back(std::make_unique<BendingAngleForce>(network, std::move(bends)));
  return forces;
}

}  // namespace sprung
