#include "network/model/spring_network.h"

#include <algorithm>

namespace sprung {

void Springs::append(Index a, Index b, double rest, double k_s, double k_d, SpringKind spring_kind, const SpringLaw& law) {
  if (laws.empty() && law != SpringLaw()) laws.resize(first.size());
  if (!laws.empty() || law != SpringLaw()) laws.push_back(law);
  first.push_back(std::min(a, b));
  second.push_back(std::max(a, b));
  rest_length.push_back(rest);
  stiffness.push_back(k_s);
  damping.push_back(k_d);
  kind.push_back(spring_kind);
}

void AngleBends::append(const std::array<Index, 3>& particles, const std::array<double, 2>& lengths, double k, double k_d) {
  before.push_back(particles[0]);
  middle.push_back(particles[1]);
  after.push_back(particles[2]);
  length_before.push_back(lengths[0]);
  length_after.push_back(lengths[1]);
  stiffness.push_back(k);
  damping.push_back(k_d);
}

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

bool bodies_may_collide(const SpringNetwork& network) {
  const auto collides_with_itself = [](const Body& body) { return body.contact.self; };
  const auto collides_with_others = [](const Body& body) { return body.contact.others; };
  return std::ranges::any_of(network.bodies, collides_with_itself) ||
         std::ranges::count_if(network.bodies, collides_with_others) > 1;
}

}  // namespace sprung
