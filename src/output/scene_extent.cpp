#include "output/scene_extent.h"

namespace sprung {
namespace {

constexpr double kRoomToMove = 2.0;
constexpr double kExtentOfNothing = 1.0;

/// Half the side [m] of the square.
double half_space_extent(const Box3& scene, const Obstacle& half_space) {
  if (scene.isEmpty()) return kExtentOfNothing;
  const auto& geometry = std::get<HalfSpaceGeometry>(half_space.geometry);
  const Vector3 middle = half_space.rest_pose * Vector3(geometry.offset * geometry.normal);
  const double reach = (scene.center() - middle).norm() + 0.5 * scene.diagonal().norm();
  return reach > 0.0 ? kRoomToMove * reach : kExtentOfNothing;
}

}  // namespace

Box3 scene_bounds(const Simulator& simulator) {
  Box3 box = bounds(simulator.positions());
  for (const Obstacle& obstacle : simulator.obstacles()) {
    if (std::holds_alternative<HalfSpaceGeometry>(obstacle.geometry)) continue;
    const RigidTransform pose = obstacle.motion.pose(obstacle.rest_pose, simulator.time());
    box.extend(bounds(pose * obstacle_mesh(obstacle.geometry, 0.0, simulator.time()).vertices));
  }
  return box;
}

TriangleMesh surface_mesh(const Obstacle& obstacle, const Box3& scene) {
  const bool endless = std::holds_alternative<HalfSpaceGeometry>(obstacle.geometry);
  return obstacle_mesh(obstacle.geometry, endless ? half_space_extent(scene, obstacle) : 0.0);
}

}  // namespace sprung
