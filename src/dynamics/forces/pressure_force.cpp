#include "dynamics/forces/pressure_force.h"

#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>

namespace sprung {

bool has_pressure(const SpringNetwork& network) {
  return std::ranges::any_of(network.bodies, [](const Body& body) { return body.pressure != 0.0; });
}

void PressureForce::add(const Kinematics& at, Points& forces) const {
  for (const Body& body : network_.bodies) {
    if (body.pressure == 0.0) continue;
    add_volume_gradients(at.x.middleCols(body.first_particle, body.particle_count), body.surface.triangles, body.pressure,
                         forces.middleCols(body.first_particle, body.particle_count));
  }
}

double PressureForce::energy(const Points& positions) const {
  double energy = 0.0;
  for (const Body& body : network_.bodies) {
    if (body.pressure == 0.0) continue;
    energy -= body.pressure * signed_volume(positions.middleCols(body.first_particle, body.particle_count), body.surface.triangles);
  }
  return energy;
}

/// A corner that moves by u turns and scales the pushes p / 6 (b - a) x (c - a) on three corners: each changes by at most p / 6 |e|
/// |u| with the edge e opposite to it. A matrix is at most the diagonal of its absolute row sums.
void PressureForce::append_elements(std::vector<LinearElement>& elements) const {
  Scalars sums = Scalars::Zero(network_.particle_count());
  for (const Body& body : network_.bodies) {
    if (body.pressure == 0.0) continue;
    for (const auto& triangle : body.surface.triangles.colwise()) {
      double edges = 0.0;
      for (int k = 0; k < 3; ++k) {
        edges += (network_.positions.col(body.first_particle + triangle[k]) -
                  network_.positions.col(body.first_particle + triangle[(k + 1) % 3]))
                     .norm();
      }
      for (const Index corner : triangle) sums[body.first_particle + corner] += std::abs(body.pressure) / 6.0 * edges;
    }
  }
  for (Index i = 0; i < sums.size(); ++i) {
    if (sums[i] > 0.0) elements.push_back(LinearElement::anchor(i, sums[i], 0.0));
  }
}

}  // namespace sprung
