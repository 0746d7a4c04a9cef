#include "benchmark/bullet_jelly.h"

#include "benchmark/bullet_world.h"

namespace sprung::benchmarks {
namespace {

constexpr double kScale = 10.0;               // as of the drape: Bullet's margins are made for units of this size
constexpr double kFloor = 2.0;                // [m], the side and height of the box that is the floor
constexpr btScalar kVolumeConservation = 20;  // of Bullet's demo of a body that keeps its volume

}  // namespace

struct BulletJelly::World : BulletWorld {
  World(const SpringNetwork& network, double gravity, double dt, int passes)
      : BulletWorld(gravity, kScale),
        step(static_cast<btScalar>(dt)),
        shape(btVector3(scaled(0.5 * kFloor), scaled(0.5 * kFloor), scaled(0.5 * kFloor))),
        floor(0, nullptr, &shape),
        body(make_body(network)) {
    floor.getWorldTransform().setOrigin(btVector3(0, scaled(-0.5 * kFloor), 0));
    dynamics.getWorldInfo().m_sparsesdf.Initialize();
    dynamics.addRigidBody(&floor);
    const Body& jelly = network.bodies.front();
    const Triangles& faces = jelly.surface.triangles;
    for (Index t = 0; t < faces.cols(); ++t) body->appendFace(faces(0, t), faces(1, t), faces(2, t));
    body->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    body->m_cfg.kDF = static_cast<btScalar>(jelly.material.friction);
    body->m_cfg.piterations = passes;
    body->m_cfg.kVC = kVolumeConservation;
    body->setPose(true, false);
    body->getCollisionShape()->setMargin(scaled(jelly.material.thickness));
    dynamics.addSoftBody(body.get());
  }
  ~World() {
    dynamics.removeSoftBody(body.get());
    dynamics.removeRigidBody(&floor);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  btScalar step;  // [s]
  btBoxShape shape;
  btRigidBody floor;
  std::unique_ptr<btSoftBody> body;
};

BulletJelly::BulletJelly(const SpringNetwork& network, double gravity, double dt, int passes)
    : world_(std::make_unique<World>(network, gravity, dt, passes)) {}
BulletJelly::~BulletJelly() = default;

void BulletJelly::step() { world_->dynamics.stepSimulation(world_->step, 0); }
Points BulletJelly::positions() const { return world_->positions(*world_->body); }

}  // namespace sprung::benchmarks
