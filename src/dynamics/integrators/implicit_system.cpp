#include "dynamics/integrators/implicit_system.h"

#include "dynamics/forces/force_derivatives.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace sprung {
namespace {

// The weight of a constraint relative to its particle's equations. They then violate it by a millionth, and 10 digits remain.
constexpr double kConstraintWeight = 1 << 20;

std::vector<bool> pins_of(const SpringNetwork& network) {
  std::vector<bool> pinned;
  for (Index i = 0; i < network.particle_count(); ++i) pinned.push_back(network.is_fixed(i));
  return pinned;
}

}  // namespace

ImplicitSystem::ImplicitSystem(const SpringNetwork& network, const ForceDerivatives& derivatives)
    : network_(network), matrix_(derivatives.by_position), factor_(matrix_, pins_of(network)) {}

void ImplicitSystem::assemble(const ForceDerivatives& derivatives, double dt) {
  matrix_.set_zero();
  for (Index i = 0; i < matrix_.size(); ++i) matrix_.add(i, i, network_.masses[i] * Matrix3::Identity());
  matrix_.add_scaled(derivatives.by_velocity, -dt);
  matrix_.add_scaled(derivatives.by_position, -dt * dt);
  weights_.resize(matrix_.size());
  for (Index i = 0; i < matrix_.size(); ++i) weights_[i] = kConstraintWeight * matrix_.diagonal(i).trace();
}

Matrix3 ImplicitSystem::constrain(Index particle, const Matrix3& projection, const Matrix3& stiffness) {
  const Matrix3 added = weights_[particle] * projection + stiffness;
  matrix_.add(particle, particle, added);
  return added;
}

Matrix3 ImplicitSystem::constrain(const ElementContact& contact, const Matrix3& projection, const Matrix3& stiffness) {
  double weight = 0.0;
  for (std::size_t k = 0; k < contact.count; ++k) weight = std::max(weight, weights_[contact.particles[k]]);
  const Matrix3 added = weight * projection + stiffness;
  for (std::size_t k = 0; k < contact.count; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      matrix_.add(contact.particles[k], contact.particles[l], contact.weights[k] * contact.weights[l] * added);
    }
  }
  return added;
}

void ImplicitSystem::solve(Points& vectors) {
  if (!factor_.factor_and_solve(matrix_, 0.0, vectors, vectors)) vectors.setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace sprung
