#include "dynamics/force.h"

namespace sprung {

void Force::prepare(double) {}

void Force::couple(std::vector<ParticlePair>&) const {}

void Force::add_derivatives(const Kinematics&, ForceDerivatives&) const {}

double Force::energy(const Points&) const { return 0.0; }

void sum_forces(const Forces& forces, const Kinematics& at, Points& total) {
  total.setZero(3, at.x.cols());
  for (const auto& force : forces) {
    force->prepare(at.time);
    force->add(at, total);
  }
}

ForceDerivatives make_derivatives(const Forces& forces, Index particles) {
  std::vector<ParticlePair> pairs;
  for (const auto& force : forces) force->couple(pairs);
  return {BlockMatrix(particles, pairs), BlockMatrix(particles, pairs)};
}

void differentiate(const Forces& forces, const Kinematics& at, ForceDerivatives& derivatives) {
  derivatives.by_position.set_zero();
  derivatives.by_velocity.set_zero();
  for (const auto& force : forces) {
    force->prepare(at.time);
    force->add_derivatives(at, derivatives);
  }
}

}  // namespace sprung
