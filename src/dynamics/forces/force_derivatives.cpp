#include "dynamics/forces/force_derivatives.h"

namespace sprung {

ForceDerivatives make_derivatives(const Forces& forces, Index particles, std::vector<ParticlePair> pairs) {
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
