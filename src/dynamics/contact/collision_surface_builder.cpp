#include "dynamics/contact/collision_surface_builder.h"

#include "dynamics/contact/contact_materials.h"

#include <utility>

namespace sprung {
namespace {

void append_elements(const Body& body, Index number, std::vector<Element>& elements) {
  const Index first = body.first_particle;
  for (const auto& corners : body.surface.triangles.colwise()) {
    elements.push_back({{first + corners[0], first + corners[1], first + corners[2]}, 3, number});
  }
  for (const auto& ends : body.surface.segments.colwise()) {
    elements.push_back({{first + ends[0], first + ends[1], kNone}, 2, number});
  }
}

}  // namespace

CollisionSurface contact_surface(const SpringNetwork& network) {
  const auto particles = static_cast<std::size_t>(network.particle_count());
  std::vector<Element> elements;
  std::vector<Index> body_of;
  std::vector<char> self;
  std::vector<char> others;
  body_of.reserve(particles);
  for (const Body& body : network.bodies) {
    const auto number = static_cast<Index>(self.size());
    append_elements(body, number, elements);
    body_of.insert(body_of.end(), static_cast<std::size_t>(body.contact_vertex_count()), number);
    body_of.resize(static_cast<std::size_t>(body.first_particle + body.particle_count), kNone);
    self.push_back(body.contact.self ? 1 : 0);
    others.push_back(body.contact.others ? 1 : 0);
  }
  return make_collision_surface(std::move(elements), network.positions, body_of, particle_thickness(network),
                                particle_motions(network), std::move(self), std::move(others));
}

ParticleMotions particle_motions(const SpringNetwork& network) {
  ParticleMotions motions;
  for (Index i = 0; i < network.particle_count(); ++i) {
    const Index pin = network.activity.pin_of[i];
    const bool is_driven = pin != kNone && network.pins[static_cast<std::size_t>(pin)].moves() && !network.is_asleep(i);
    motions.push_back(is_driven ? ParticleMotion::driven : network.is_fixed(i) ? ParticleMotion::at_rest : ParticleMotion::free);
  }
  return motions;
}

}  // namespace sprung
