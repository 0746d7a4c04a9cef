#include "collision/obstacles/broad_phase.h"

#include "collision/shapes/mesh_shape.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <utility>

namespace sprung {

namespace {

using FclGeometry = std::shared_ptr<fcl::CollisionGeometry<double>>;

FclGeometry fcl_geometry(const MeshGeometry& /*mesh*/, const ObstacleShape& shape) {
  return static_cast<const MeshShape&>(shape).tree().model();
}
FclGeometry fcl_geometry(const SequenceGeometry& /*sequence*/, const ObstacleShape& shape) {
  return static_cast<const MeshShape&>(shape).tree().model();
}
FclGeometry fcl_geometry(const SphereGeometry& sphere, const ObstacleShape& /*shape*/) {
  return std::make_shared<fcl::Sphere<double>>(sphere.radius);
}
FclGeometry fcl_geometry(const BoxGeometry& box, const ObstacleShape& /*shape*/) {
  return std::make_shared<fcl::Box<double>>(box.size);
}
FclGeometry fcl_geometry(const CapsuleGeometry& capsule, const ObstacleShape& /*shape*/) {
  return std::make_shared<fcl::Capsule<double>>(capsule.radius, capsule.length);
}
FclGeometry fcl_geometry(const CylinderGeometry& cylinder, const ObstacleShape& /*shape*/) {
  return std::make_shared<fcl::Cylinder<double>>(cylinder.radius, cylinder.height);
}
FclGeometry fcl_geometry(const ConeGeometry& cone, const ObstacleShape& /*shape*/) {
  return std::make_shared<fcl::Cone<double>>(cone.radius, cone.height);
}
FclGeometry fcl_geometry(const EllipsoidGeometry& ellipsoid, const ObstacleShape& /*shape*/) {
  return std::make_shared<fcl::Ellipsoid<double>>(ellipsoid.radii);
}
FclGeometry fcl_geometry(const HalfSpaceGeometry& /*half_space*/, const ObstacleShape& /*shape*/) { return nullptr; }

RigidTransform rotation_of(const ObstacleGeometry& geometry) {
  RigidTransform rotation = RigidTransform::Identity();
  const bool stands = std::holds_alternative<CapsuleGeometry>(geometry) || std::holds_alternative<CylinderGeometry>(geometry) ||
                      std::holds_alternative<ConeGeometry>(geometry);
  if (stands) rotation.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return rotation;
}

/// A box in the obstacle's frame, or in FCL's frame of the shape, and a ball around it [m].
struct LocalBox {
  Box3 box;
  Vector3 center = Vector3::Zero();
  double radius = 0.0;
};

LocalBox local_box(const fcl::CollisionGeometry<double>& geometry) {
  return {Box3(geometry.aabb_local.min_, geometry.aabb_local.max_), geometry.aabb_center, geometry.aabb_radius};
}

/// The box of a mesh that deforms contains it throughout an interval. FCL would compute it from the vertices at the end.
LocalBox local_box(const Box3& box) { return {box, box.center(), 0.5 * box.diagonal().norm()}; }

/// The box of FCL's object with this pose.
Box3 world_box(const LocalBox& local, const RigidTransform& pose) {
  if (pose.linear().isIdentity()) return local.box.translated(pose.translation());
  const Vector3 center = pose * local.center;
  return {center - Vector3::Constant(local.radius), center + Vector3::Constant(local.radius)};
}

HalfSpaceGeometry world_plane(const HalfSpaceGeometry& local, const RigidTransform& pose) {
  const Vector3 normal = pose.linear() * local.normal;
  return {normal, local.offset + normal.dot(pose.translation())};
}

bool intersects(const HalfSpaceGeometry& half_space, const Box3& box) {
  const Vector3& n = half_space.normal;
  return n.dot(box.center()) - 0.5 * n.cwiseAbs().dot(box.sizes()) <= half_space.offset;
}

bool add_obstacle(fcl::CollisionObject<double>* object, fcl::CollisionObject<double>* /*query*/, void* found) {
  static_cast<std::vector<Index>*>(found)->push_back(*static_cast<const Index*>(object->getUserData()));
  return false;
}

}  // namespace

struct BroadPhase::Implementation {
  struct Object {
    std::unique_ptr<fcl::CollisionObject<double>> object;
    std::unique_ptr<Index> obstacle;
  };
  /// An obstacle in its own frame, for bound_at().
  struct Local {
    std::variant<LocalBox, HalfSpaceGeometry> bound;
    RigidTransform rotation = RigidTransform::Identity();  ///< from FCL's frame of the shape, with axis z, to the obstacle's
  };

  std::vector<Local> locals;          ///< by obstacle
  std::vector<Object> objects;        ///< that never change
  std::vector<ObstacleBound> planes;  ///< that never change
  fcl::DynamicAABBTreeCollisionManager<double> manager;
};

BroadPhase::BroadPhase(const std::vector<Obstacle>& obstacles, const std::vector<std::shared_ptr<const ObstacleShape>>& shapes,
                       const std::vector<RigidTransform>& poses)
    : implementation_(std::make_unique<Implementation>()) {
  auto& [locals, objects, planes, manager] = *implementation_;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const ObstacleGeometry& geometry = obstacles[k].geometry;
    const bool changes = obstacles[k].motion.moves() || shapes[k]->deforms();
    const auto number = static_cast<Index>(k);
    if (const auto* half_space = std::get_if<HalfSpaceGeometry>(&geometry)) {
      locals.push_back({*half_space});
      if (!changes) planes.push_back({number, world_plane(*half_space, poses[k])});
      continue;
    }
    const auto fcl_shape = std::visit([&](const auto& of_kind) { return fcl_geometry(of_kind, *shapes[k]); }, geometry);
    const RigidTransform rotation = rotation_of(geometry);
    auto object = std::make_unique<fcl::CollisionObject<double>>(fcl_shape, poses[k] * rotation);
    locals.push_back({local_box(*fcl_shape), rotation});
    if (changes) continue;
    object->computeAABB();
    auto user_data = std::make_unique<Index>(number);
    object->setUserData(user_data.get());
    manager.registerObject(object.get());
    objects.push_back({std::move(object), std::move(user_data)});
  }
  manager.setup();
}

BroadPhase::~BroadPhase() = default;

ObstacleBound BroadPhase::bound_at(Index k, const RigidTransform& pose, const ObstacleShape& shape) const {
  const Implementation::Local& local = implementation_->locals[static_cast<std::size_t>(k)];
  if (const auto* half_space = std::get_if<HalfSpaceGeometry>(&local.bound)) return {k, world_plane(*half_space, pose)};
  const LocalBox box = shape.deforms() ? local_box(shape.bounds()) : std::get<LocalBox>(local.bound);
  return {k, world_box(box, pose * local.rotation)};
}

void BroadPhase::find_near(const Box3& box, const std::vector<ObstacleBound>& changing, std::vector<Index>& found) const {
  found.clear();
  if (!implementation_->objects.empty()) {
    const auto shape = std::make_shared<fcl::Box<double>>(fcl::Vector3<double>(box.sizes()));
    fcl::CollisionObject<double> query(shape, Matrix3::Identity(), box.center());
    implementation_->manager.collide(&query, &found, add_obstacle);
  }
  const Box3 as_in_tree(box.center() - 0.5 * box.sizes(), box.center() + 0.5 * box.sizes());  // to the last bit
  for (const std::vector<ObstacleBound>* bounds : {&std::as_const(implementation_->planes), &changing}) {
    for (const auto& [obstacle, bound] : *bounds) {
      const auto* of_obstacle = std::get_if<Box3>(&bound);
      const bool is_near =
          of_obstacle != nullptr ? of_obstacle->intersects(as_in_tree) : intersects(std::get<HalfSpaceGeometry>(bound), box);
      if (is_near) found.push_back(obstacle);
    }
  }
  std::sort(found.begin(), found.end());
}

}  // namespace sprung
