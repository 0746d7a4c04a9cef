#include "benchmark/bullet_drape.h"

#include "benchmark/bullet_world.h"
#include "benchmark/field_drape.h"

#include <vector>

namespace sprung::benchmarks {

namespace {

constexpr double kScale = 10.0;
constexpr int kSteps = 4;
static_assert(kPasses % kSteps == 0);

/// Bullet keeps pointers into these.
struct MeshArrays {
  MeshArrays(const TriangleMesh& mesh, const BulletWorld& world) {
    for (const Index corner : mesh.triangles.reshaped()) indices.push_back(corner);
    for (Index i = 0; i < mesh.vertices.cols(); ++i) {
      const btVector3 p = world.scaled(Vector3(mesh.vertices.col(i)));
      vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
    }
  }

  std::vector<int> indices;
  std::vector<btScalar> vertices;
};

}  // namespace

struct BulletDrape::World : BulletWorld {
  World(Index triangles, Index side);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  MeshArrays arrays;
  btTriangleIndexVertexArray mesh;
  btBvhTriangleMeshShape shape;
  btRigidBody obstacle;
  std::unique_ptr<btSoftBody> cloth;
};

BulletDrape::World::World(Index triangles, Index side)
    : BulletWorld(kGravity, kScale),
      arrays(drape_mesh(triangles), *this),
      mesh(static_cast<int>(arrays.indices.size() / 3), arrays.indices.data(), 3 * sizeof(int),
           static_cast<int>(arrays.vertices.size() / 3), arrays.vertices.data(), 3 * sizeof(btScalar)),
      shape(&mesh, true),
      obstacle(0, nullptr, &shape) {
  btSoftBodyWorldInfo& info = dynamics.getWorldInfo();
  info.m_sparsesdf.setDefaultVoxelsz(0.1F);
  info.m_sparsesdf.Reset();
  shape.setMargin(0);
  obstacle.setFriction(1);  // the pair's is the product
  dynamics.addRigidBody(&obstacle);
  const SpringNetwork network = drape_network(triangles, side);
  cloth = make_body(network);
  const Triangles faces = network.bodies.front().surface.triangles;
  for (Index t = 0; t < faces.cols(); ++t) cloth->appendFace(faces(0, t), faces(1, t), faces(2, t));
  cloth->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  cloth->m_cfg.kDF = static_cast<btScalar>(kFriction);
  cloth->m_cfg.piterations = kPasses / kSteps;
  cloth->getCollisionShape()->setMargin(scaled(kThickness));
  dynamics.addSoftBody(cloth.get());
}

BulletDrape::World::~World() {
  dynamics.removeSoftBody(cloth.get());
  dynamics.removeRigidBody(&obstacle);
}

BulletDrape::BulletDrape(Index triangles, Index side) : world_(std::make_unique<World>(triangles, side)) {}
BulletDrape::~BulletDrape() = default;

void BulletDrape::step_frame() {
  for (int step = 0; step < kSteps; ++step) world_->dynamics.stepSimulation(static_cast<btScalar>(kFrameTime / kSteps), 0);
}

Points BulletDrape::positions() const { return world_->positions(*world_->cloth); }

}  // namespace sprung::benchmarks
