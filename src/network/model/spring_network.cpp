#include "network/model/spring_network.h"

#include <algorithm>

namespace sprung {

const Body& SpringNetwork::body_of(Index particle) const {
  const auto after =
      std::upper_bound(bodies.begin(), bodies.end(), particle, [](Index p, const Body& body) { return p < body.first_particle; });
  return *std::prev(after);
}

Points contact_positions(const SpringNetwork& network, const Points& positions) {
  Index count = 0;
  Points vertices(3, network.particle_count());
  for (const Body& body : network.bodies) {
    vertices.middleCols(count, body.contact_vertex_count()) =
        positions.middleCols(body.first_particle, body.contact_vertex_count());
    count += body.contact_vertex_count();
  }
  vertices.conservativeResize(3, count);
  return vertices;
}

bool has_triangles(const SpringNetwork& network) {
  return std::ranges::any_of(network.bodies, [](const Body& body) { return body.surface.triangles.cols() > 0; });
}

bool has_own_drag(const SpringNetwork& network) {
  return std::ranges::any_of(network.bodies, [](const Body& body) { return !body.drag.is_zero(); });
}

bool bodies_may_collide(const SpringNetwork& network) {
  const auto collides_with_itself = [](const Body& body) { return body.contact.self; };
  const auto collides_with_others = [](const Body& body) { return body.contact.others; };
  return std::ranges::any_of(network.bodies, collides_with_itself) ||
         std::ranges::count_if(network.bodies, collides_with_others) > 1;
}

}  // namespace sprung
