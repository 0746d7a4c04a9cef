#include "dynamics/forces/force.h"

#include <algorithm>

namespace sprung {

LinearElement LinearElement::of(std::span<const Index> particles, std::span<const double> weights, double stiffness,
                                double damping) {
  LinearElement element{.count = particles.size(), .stiffness = stiffness, .damping = damping};
  std::ranges::copy(particles, element.particles.begin());
  std::ranges::copy(weights, element.weights.begin());
  return element;
}

LinearElement LinearElement::anchor(Index particle, double stiffness, double damping) {
  return {.particles = {particle}, .weights = {1.0}, .count = 1, .stiffness = stiffness, .damping = damping};
}

LinearElement LinearElement::pair(Index first, Index second, double stiffness, double damping) {
  return {.particles = {first, second}, .weights = {1.0, -1.0}, .count = 2, .stiffness = stiffness, .damping = damping};
}

std::string Force::name() const { return "added forces"; }

void Force::prepare(double) {}
void Force::hold(const Points&) {}

void Force::follow(const Conditions&) {}

void Force::set_step(double) {}

std::optional<std::vector<Index>> Force::touched() const { return std::nullopt; }

bool Force::is_constant() const { return false; }

void Force::couple(std::vector<ParticlePair>&) const {}

void Force::add_derivatives(const Kinematics&, ForceDerivatives&) const {}

void Force::append_elements(std::vector<LinearElement>&) const {}

void Force::note_solution(const Points&) {}

double Force::energy(const Points&) const { return 0.0; }

EnergyKind Force::energy_kind() const { return EnergyKind::elastic; }

double Force::capacity() const { return 0.0; }

double Force::largest_acceleration() const { return 0.0; }

bool are_constant(const Forces& forces) {
  return std::ranges::all_of(forces, [](const auto& force) { return force->is_constant(); });
}

double energy_of(const Forces& forces, EnergyKind kind, const Points& positions) {
  double energy = 0.0;
  for (const auto& force : forces) {
    if (force->energy_kind() == kind) energy += force->energy(positions);
  }
  return energy;
}

double largest_acceleration(const Forces& forces) {
  double sum = 0.0;
  for (const auto& force : forces) sum += force->largest_acceleration();
  return sum;
}

void sum_forces(const Forces& forces, const Kinematics& at, Points& total) {
  total.setZero(3, at.x.cols());
  for (const auto& force : forces) {
    force->prepare(at.time);
    force->add(at, total);
  }
}

}  // namespace sprung
