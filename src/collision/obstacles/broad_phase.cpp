#include "collision/obstacles/broad_phase.h"

#include "collision/shapes/mesh_shape.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>

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

/// FCL would compute the box of a mesh from its vertices at the end of the interval only.
void fit_box(const Box3& box, fcl::CollisionGeometry<double>& geometry) {
  geometry.aabb_local = fcl::AABB<double>(box.min(), box.max());
  geometry.aabb_center = box.center();
  geometry.aabb_radius = 0.5 * box.diagonal().norm();
}

bool add_obstacle(fcl::CollisionObject<double>* object, fcl::CollisionObject<double>* /*query*/, void* found) {
  static_cast<std::vector<Index>*>(found)->push_back(*static_cast<const Index*>(object->getUserData()));
  return false;
}

}  // namespace

BroadPhase::BroadPhase(const std::vector<Obstacle>& obstacles, const std::vector<std::unique_ptr<ObstacleShape>>& shapes,
                       const std::vector<RigidTransform>& poses) {
  objects_.reserve(obstacles.size());
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const ObstacleGeometry& geometry = obstacles[k].geometry;
    const auto number = static_cast<Index>(k);
    if (const auto* half_space = std::get_if<HalfSpaceGeometry>(&geometry)) {
      planes_.push_back({*half_space, *half_space, number});
      continue;
    }
    const auto fcl_shape = std::visit([&](const auto& of_kind) { return fcl_geometry(of_kind, *shapes[k]); }, geometry);
    Object& added = objects_.emplace_back(Object{std::make_unique<fcl::CollisionObject<double>>(fcl_shape), fcl_shape,
                                                 shapes[k].get(), rotation_of(geometry), number});
    added.object->setUserData(&added.obstacle);
    manager_.registerObject(added.object.get());
  }
  manager_.setup();
  move(poses);
}

void BroadPhase::move(const std::vector<RigidTransform>& poses) {
  for (Object& object : objects_) {
    if (object.shape->deforms()) fit_box(object.shape->bounds(), *object.geometry);
    object.object->setTransform(poses[object.obstacle] * object.rotation);
    object.object->computeAABB();
  }
  for (Plane& plane : planes_) {
    const RigidTransform& pose = poses[plane.obstacle];
    plane.world.normal = pose.linear() * plane.local.normal;
    plane.world.offset = plane.local.offset + plane.world.normal.dot(pose.translation());
  }
  if (!objects_.empty()) manager_.update();
}

void BroadPhase::find_near(const Box3& box, std::vector<Index>& found) const {
  found.clear();
  if (!objects_.empty()) {
    const auto shape = std::make_shared<fcl::Box<double>>(fcl::Vector3<double>(box.sizes()));
    fcl::CollisionObject<double> query(shape, Matrix3::Identity(), box.center());
    manager_.collide(&query, &found, add_obstacle);
  }
  for (const Plane& plane : planes_) {
    const Vector3& n = plane.world.normal;
    const double lowest = n.dot(box.center()) - 0.5 * n.cwiseAbs().dot(box.sizes());
    if (lowest <= plane.world.offset) found.push_back(plane.obstacle);
  }
  std::sort(found.begin(), found.end());
}

}  // namespace sprung
