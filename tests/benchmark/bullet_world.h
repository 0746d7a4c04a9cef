// An empty world of Bullet's soft bodies, and networks converted to them. For the .cpp files that use Bullet.
#pragma once

#include "network/model/spring_network.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>

namespace sprung::benchmarks {

struct BulletWorld {
  /// Gravity [m/s^2] acts along -y; a metre has `scale` units of Bullet.
  BulletWorld(double gravity, double scale);
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// A body with the network's particles, and its springs as links.
  [[nodiscard]] std::unique_ptr<btSoftBody> make_body(const SpringNetwork& network);

  [[nodiscard]] btVector3 scaled(const Vector3& p) const;
  [[nodiscard]] btScalar scaled(double length) const { return static_cast<btScalar>(scale * length); }
  [[nodiscard]] Points positions(const btSoftBody& body) const;  ///< [m]

  double scale;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld dynamics{&dispatcher, &broad_phase, &solver, &configuration};
};

}  // namespace sprung::benchmarks
