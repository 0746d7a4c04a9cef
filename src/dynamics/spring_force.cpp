#include "dynamics/spring_force.h"

#include <cmath>

namespace sprung {

struct SpringForce::Plan {};

SpringForce::SpringForce(const SpringNetwork& network) : network_(network) {}
SpringForce::~SpringForce() = default;

void SpringForce::add(const Kinematics& at, Points& forces) const {
  const Springs& springs = network_.springs;
  for (std::size_t k = 0; k < springs.first.size(); ++k) {
    const Index a = springs.first[k];
    const Index b = springs.second[k];
    const Vector3 s = at.x.col(a) - at.x.col(b);
    const double length = s.norm();
    if (length == 0.0) continue;
    const Vector3 e = s / length;
    const double damped = springs.damping[k] * e.dot(at.v.col(a) - at.v.col(b));
    const Vector3 force = (-springs.stiffness[k] * (length - springs.rest_length[k]) - damped) * e;
    forces.col(a) += force;
    forces.col(b) -= force;
  }
}

double SpringForce::energy(const Points& positions) const {
  const Springs& springs = network_.springs;
  double energy = 0.0;
  for (std::size_t k = 0; k < springs.first.size(); ++k) {
    const double stretch = (positions.col(springs.first[k]) - positions.col(springs.second[k])).norm() - springs.rest_length[k];
    energy += 0.5 * springs.stiffness[k] * stretch * stretch;
  }
  return energy;
}

}  // namespace sprung
