#include "collision/obstacles/obstacle_set.h"

#include "base/error.h"
#include "base/problem_list.h"
#include "collision/obstacles/broad_phase.h"
#include "collision/obstacles/obstacle_frame.h"
#include "geometry/motion/motion_check.h"

#include <algorithm>

namespace sprung {

namespace {

double largest(const Vector3& p) { return p.cwiseAbs().maxCoeff(); }

/// Builds the shape of the obstacle. Returns null and adds the problems if it is invalid.
std::unique_ptr<ObstacleShape> checked_shape(const std::string& key, const ObstacleGeometry& geometry, ProblemList& problems) {
  try {
    return make_shape(geometry);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      problems.add(key + "." + problem.key, problem.value, problem.rule, problem.remedy);
    }
    return nullptr;
  }
}

std::vector<std::shared_ptr<const ObstacleShape>> checked_shapes(const std::vector<Obstacle>& obstacles) {
  std::vector<std::shared_ptr<const ObstacleShape>> shapes;
  ProblemList problems;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const Obstacle& obstacle = obstacles[k];
    const std::string key = obstacle_key(obstacle, k);
    shapes.push_back(checked_shape(key + ".shape", obstacle.geometry, problems));
    check_pose(key + ".rest_pose", obstacle.rest_pose, problems);
    check_motion(key + ".motion", obstacle.motion, problems);
    check_material(key, obstacle.material, problems);
  }
  problems.throw_if_any();
  return shapes;
}

PosedObstacle posed_in(const Obstacle& obstacle, std::shared_ptr<const ObstacleShape> shape, double begin, double end) {
  PosedObstacle posed;
  posed.before = obstacle.motion.pose(obstacle.rest_pose, begin);
  posed.after = obstacle.motion.pose(obstacle.rest_pose, end);
  posed.into_before = posed.before.inverse();
  posed.into_after = posed.after.inverse();
  posed.magnitude = shape->magnitude() + std::max(largest(posed.before.translation()), largest(posed.after.translation()));
  posed.is_at_rest = posed.before.matrix() == posed.after.matrix() && shape->largest_displacement() == 0.0;
  posed.shape = std::move(shape);
  return posed;
}

}  // namespace

std::string obstacle_key(const Obstacle& obstacle, std::size_t number) {
  return obstacle.name.empty() ? entry_key("obstacles", number) : "obstacles." + obstacle.name;
}

ObstacleSet::ObstacleSet(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)), shapes_(checked_shapes(obstacles_)) {
  pose();
}

/// At time 0, where the broad phase has the obstacles that never change.
void ObstacleSet::pose() {
  auto at_start = std::make_shared<PosedObstacles>();
  std::vector<RigidTransform> poses;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const PosedObstacle& posed = at_start->each.emplace_back(posed_in(obstacles_[k], shapes_[k], 0.0, 0.0));
    poses.push_back(posed.after);
    at_start->max_magnitude = std::max(at_start->max_magnitude, posed.magnitude);
    max_thickness_ = std::max(max_thickness_, obstacles_[k].material.thickness);
    moves_ = moves_ || changes(k);
  }
  broad_phase_ = std::make_shared<const BroadPhase>(obstacles_, shapes_, poses);
  at_start_ = std::move(at_start);
}

void ObstacleSet::set_motion(Index k, const Motion& motion) {
  const bool changed_before = changes(static_cast<std::size_t>(k));
  obstacles_[static_cast<std::size_t>(k)].motion = motion;
  if (changes(static_cast<std::size_t>(k)) != changed_before) pose();
}

void ObstacleSet::set_material(Index k, const ContactMaterial& material) {
  obstacles_[static_cast<std::size_t>(k)].material = material;
  max_thickness_ = 0.0;
  for (const Obstacle& obstacle : obstacles_) max_thickness_ = std::max(max_thickness_, obstacle.material.thickness);
}

std::shared_ptr<const PosedObstacles> ObstacleSet::posed(double begin, double end) const {
  if (!moves_) return at_start_;
  auto posed = std::make_shared<PosedObstacles>();
  posed->each = at_start_->each;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    PosedObstacle& own = posed->each[k];
    if (changes(k)) {
      const auto number = static_cast<Index>(k);
      own = posed_in(obstacles_[k], shapes_[k]->deforms() ? shapes_[k]->in_interval(begin, end) : shapes_[k], begin, end);
      posed->changing.push_back(broad_phase_->bound_at(number, own.after, *own.shape));
    }
    posed->max_magnitude = std::max(posed->max_magnitude, own.magnitude);
  }
  return posed;
}

bool ObstacleSet::changes(std::size_t k) const { return obstacles_[k].motion.moves() || shapes_[k]->deforms(); }

}  // namespace sprung
