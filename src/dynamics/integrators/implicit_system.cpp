#include "dynamics/integrators/implicit_system.h"

#include <limits>
#include <vector>

namespace sprung {
namespace {

// The weight of a constraint relative to its particle's equations. They then violate it by a millionth, and 10 digits remain.
constexpr double kConstraintWeight = 1 << 20;

std::vector<bool> pins_of(const SpringNetwork& network) {
  std::vector<bool> pinned;
  for (Index i = 0; i < network.particle_count(); ++i) pinned.push_back(network.is_pinned(i));
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
}

Matrix3 ImplicitSystem::constrain(Index particle, const Matrix3& projection, const Matrix3& stiffness) {
  const Matrix3 added = kConstraintWeight * matrix_.diagonal(particle).trace() * projection + stiffness;
  matrix_.add(particle, particle, added);
  return added;
}

void ImplicitSystem::solve(Points& vectors) {
  if (!factor_.factor_and_solve(matrix_, 0.0, vectors, vectors)) vectors.setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace sprung
