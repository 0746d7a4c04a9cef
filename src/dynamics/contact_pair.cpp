#include "dynamics/contact_pair.h"

#include <algorithm>
#include <cmath>

namespace sprung {

ContactMaterial combine(const ContactMaterial& body, const ContactMaterial& obstacle) {
  return {.thickness = body.thickness + obstacle.thickness,
          .friction = std::sqrt(body.friction * obstacle.friction),
          .static_friction = std::sqrt(body.static_friction * obstacle.static_friction),
          .restitution = std::max(body.restitution, obstacle.restitution)};
}

Scalars particle_thickness(const SpringNetwork& network) {
  Scalars thickness(network.particle_count());
  for (const Body& body : network.bodies) {
    thickness.segment(body.first_particle, body.particle_count).setConstant(body.material.thickness);
  }
  return thickness;
}

}  // namespace sprung
