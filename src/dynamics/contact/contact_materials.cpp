#include "dynamics/contact/contact_materials.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

ContactMaterial combine_sides(const ContactMaterial& first, const ContactMaterial& second, double thickness) {
  return {.thickness = thickness,
          .friction = std::sqrt(first.friction * second.friction),
          .static_friction = std::sqrt(first.static_friction * second.static_friction),
          .restitution = std::max(first.restitution, second.restitution)};
}

}  // namespace

ContactMaterial combine(const ContactMaterial& body, const ContactMaterial& obstacle) {
  return combine_sides(body, obstacle, body.thickness + obstacle.thickness);
}

ContactMaterial combine_bodies(const ContactMaterial& first, const ContactMaterial& second) {
  return combine_sides(first, second, 0.5 * (first.thickness + second.thickness));
}

Scalars particle_thickness(const SpringNetwork& network) {
  Scalars thickness(network.particle_count());
  for (const Body& body : network.bodies) {
    thickness.segment(body.first_particle, body.particle_count).setConstant(body.material.thickness);
  }
  return thickness;
}

ContactMaterials::ContactMaterials(const SpringNetwork& network, const std::vector<Obstacle>& obstacles)
    : network_(network), obstacles_(obstacles) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    body_of_.insert(body_of_.end(), static_cast<std::size_t>(network.bodies[b].particle_count), static_cast<Index>(b));
  }
}

const ContactMaterial& ContactMaterials::of(const Contact& contact, Last& last) const {
  const Pair pair = pair_of(contact);
  if (pair == last.pair) return last.material;
  last.pair = pair;
  const ContactMaterial& body = network_.bodies[static_cast<std::size_t>(pair.body)].material;
  last.material = pair.obstacle != kNone
                      ? combine(body, obstacles_[static_cast<std::size_t>(pair.obstacle)].material)
                      : combine_bodies(body, network_.bodies[static_cast<std::size_t>(pair.other_body)].material);
  return last.material;
}

// A corner of weight 0 does not determine the body of its side.
ContactMaterials::Pair ContactMaterials::pair_of(const Contact& contact) const {
  Pair pair{.obstacle = contact.obstacle};
  for (int k = 0; k < contact.count; ++k) {
    const auto corner = static_cast<std::size_t>(k);
    const Index body = body_of_[static_cast<std::size_t>(contact.particles[corner])];
    if (contact.weights[corner] > 0.0) pair.body = body;
    if (contact.weights[corner] < 0.0) pair.other_body = body;
  }
  return pair;
}

}  // namespace sprung
