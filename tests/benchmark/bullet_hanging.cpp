#include "benchmark/bullet_hanging.h"

#include "benchmark/bullet_world.h"

namespace sprung::benchmarks {

struct BulletHanging::World : BulletWorld {
  World(const SpringNetwork& network, double gravity, double frame, int passes)
      : BulletWorld(gravity, 1.0), frame_time(static_cast<btScalar>(frame)), body(make_body(network)) {
    body->m_cfg.piterations = passes;
    body->m_cfg.collisions = 0;
    dynamics.addSoftBody(body.get());
  }
  ~World() { dynamics.removeSoftBody(body.get()); }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  btScalar frame_time;
  std::unique_ptr<btSoftBody> body;
};

BulletHanging::BulletHanging(const SpringNetwork& network, double gravity, double frame_time, int passes)
    : world_(std::make_unique<World>(network, gravity, frame_time, passes)) {}
BulletHanging::~BulletHanging() = default;

void BulletHanging::step_frame() { world_->dynamics.stepSimulation(world_->frame_time, 0); }
Points BulletHanging::positions() const { return world_->positions(*world_->body); }

}  // namespace sprung::benchmarks
