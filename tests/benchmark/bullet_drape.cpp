#include "benchmark/bullet_drape.h"

#include "benchmark/field_drape.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <vector>

namespace sprung::benchmarks {

namespace {

constexpr double kScale = 10.0;
constexpr int kSteps = 4;
static_assert(kPasses % kSteps == 0);

btVector3 scaled(const Vector3& p) {
  return {static_cast<btScalar>(kScale * p.x()), static_cast<btScalar>(kScale * p.y()), static_cast<btScalar>(kScale * p.z())};
}

btScalar scaled(double length) { return static_cast<btScalar>(kScale * length); }

/// Bullet keeps pointers into these.
struct MeshArrays {
  explicit MeshArrays(const TriangleMesh& mesh) {
    for (const Index corner : mesh.triangles.reshaped()) indices.push_back(corner);
    for (Index i = 0; i < mesh.vertices.cols(); ++i) {
      const btVector3 p = scaled(Vector3(mesh.vertices.col(i)));
      vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
    }
  }

  std::vector<int> indices;
  std::vector<btScalar> vertices;
};

}  // namespace

struct BulletDrape::World {
  World(Index triangles, Index side);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void make_cloth(const SpringNetwork& network);

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld dynamics{&dispatcher, &broad_phase, &solver, &configuration};
  MeshArrays arrays;
  btTriangleIndexVertexArray mesh;
  btBvhTriangleMeshShape shape;
  btRigidBody obstacle;
  std::unique_ptr<btSoftBody> cloth;
};

BulletDrape::World::World(Index triangles, Index side)
    : arrays(drape_mesh(triangles)),
      mesh(static_cast<int>(arrays.indices.size() / 3), arrays.indices.data(), 3 * sizeof(int),
           static_cast<int>(arrays.vertices.size() / 3), arrays.vertices.data(), 3 * sizeof(btScalar)),
      shape(&mesh, true),
      obstacle(0, nullptr, &shape) {
  const btVector3 gravity(0, scaled(-kGravity), 0);
  dynamics.setGravity(gravity);
  btSoftBodyWorldInfo& info = dynamics.getWorldInfo();
  info.m_gravity = gravity;
  info.air_density = 0;
  info.m_dispatcher = &dispatcher;
  info.m_broadphase = &broad_phase;
  info.m_sparsesdf.setDefaultVoxelsz(0.1F);
  info.m_sparsesdf.Reset();
  shape.setMargin(0);
  obstacle.setFriction(1);  // the pair's is the product
  dynamics.addRigidBody(&obstacle);
  make_cloth(drape_network(triangles, side));
  dynamics.addSoftBody(cloth.get());
}

BulletDrape::World::~World() {
  dynamics.removeSoftBody(cloth.get());
  dynamics.removeRigidBody(&obstacle);
}

void BulletDrape::World::make_cloth(const SpringNetwork& network) {
  std::vector<btVector3> positions;
  std::vector<btScalar> masses;
  for (Index i = 0; i < network.particle_count(); ++i) {
    positions.push_back(scaled(Vector3(network.positions.col(i))));
    masses.push_back(static_cast<btScalar>(network.masses[i]));
  }
  cloth = std::make_unique<btSoftBody>(&dynamics.getWorldInfo(), network.particle_count(), positions.data(), masses.data());
  for (Index s = 0; s < network.springs.count(); ++s) cloth->appendLink(network.springs.first[s], network.springs.second[s]);
  const Triangles faces = network.bodies.front().surface.triangles;
  for (Index t = 0; t < faces.cols(); ++t) cloth->appendFace(faces(0, t), faces(1, t), faces(2, t));
  cloth->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  cloth->m_cfg.kDF = static_cast<btScalar>(kFriction);
  cloth->m_cfg.piterations = kPasses / kSteps;
  cloth->getCollisionShape()->setMargin(scaled(kThickness));
}

BulletDrape::BulletDrape(Index triangles, Index side) : world_(std::make_unique<World>(triangles, side)) {}
BulletDrape::~BulletDrape() = default;

void BulletDrape::step_frame() {
  for (int step = 0; step < kSteps; ++step) world_->dynamics.stepSimulation(static_cast<btScalar>(kFrameTime / kSteps), 0);
}

Points BulletDrape::positions() const {
  const auto& nodes = world_->cloth->m_nodes;
  Points positions(3, nodes.size());
  for (int i = 0; i < nodes.size(); ++i) {
    const btVector3& x = nodes[i].m_x;
    positions.col(i) = Vector3(x.x(), x.y(), x.z()) / kScale;
  }
  return positions;
}

}  // namespace sprung::benchmarks
