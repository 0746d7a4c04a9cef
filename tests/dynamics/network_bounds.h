// Bounds on the fastest modes of networks alone.
#pragma once

#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/integrators/spectral_bounds.h"

namespace sprung {

/// Of springs, angle bends and air drag.
inline SpectralBounds spectral_bounds(const SpringNetwork& network, double drag = 0.0) {
  std::vector<LinearElement> elements;
  SpringForce(network).append_elements(elements);
  BendingAngleForce(network).append_elements(elements);
  AirDrag(network, drag, Vector3::Zero()).append_elements(elements);
  return spectral_bounds(elements, network.inverse_masses);
}

}  // namespace sprung
