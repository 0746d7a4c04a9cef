#include "benchmark/bullet_world.h"

#include <vector>

namespace sprung::benchmarks {

BulletWorld::BulletWorld(double gravity, double units) : scale(units) {
  const btVector3 down(0, scaled(-gravity), 0);
  dynamics.setGravity(down);
  btSoftBodyWorldInfo& info = dynamics.getWorldInfo();
  info.m_gravity = down;
  info.air_density = 0;
  info.m_dispatcher = &dispatcher;
  info.m_broadphase = &broad_phase;
}

std::unique_ptr<btSoftBody> BulletWorld::make_body(const SpringNetwork& network) {
  std::vector<btVector3> positions;
  std::vector<btScalar> masses;
  for (Index i = 0; i < network.particle_count(); ++i) {
    positions.push_back(scaled(Vector3(network.positions.col(i))));
    masses.push_back(network.is_fixed(i) ? 0 : static_cast<btScalar>(network.masses[i]));
  }
  auto body = std::make_unique<btSoftBody>(&dynamics.getWorldInfo(), network.particle_count(), positions.data(), masses.data());
  for (Index s = 0; s < network.springs.count(); ++s) body->appendLink(network.springs.first[s], network.springs.second[s]);
  return body;
}

btVector3 BulletWorld::scaled(const Vector3& p) const { return {scaled(p.x()), scaled(p.y()), scaled(p.z())}; }

Points BulletWorld::positions(const btSoftBody& body) const {
  Points positions(3, body.m_nodes.size());
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& x = body.m_nodes[i].m_x;
    positions.col(i) = Vector3(x.x(), x.y(), x.z()) / scale;
  }
  return positions;
}

}  // namespace sprung::benchmarks
