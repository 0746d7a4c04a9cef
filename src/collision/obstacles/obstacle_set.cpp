#include "collision/obstacles/obstacle_set.h"

#include "base/error.h"
#include "base/problem_list.h"
#include "collision/core/block_bounds.h"
#include "collision/core/contact_constants.h"
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

std::vector<std::unique_ptr<ObstacleShape>> checked_shapes(const std::vector<Obstacle>& obstacles) {
  std::vector<std::unique_ptr<ObstacleShape>> shapes;
  ProblemList problems;
  for (const Obstacle& obstacle : obstacles) {
    const std::string key = "obstacles." + obstacle.name;
    shapes.push_back(checked_shape(key + ".shape", obstacle.geometry, problems));
    if (!obstacle.rest_pose.matrix().allFinite()) {
      problems.add(key + ".place", "", "must be finite", "give a position in m and a rotation in degrees");
    }
    check_motion(key + ".motion", obstacle.motion, problems);
    check_material(key, obstacle.material, problems);
  }
  problems.throw_if_any();
  return shapes;
}

}  // namespace

ObstacleSet::ObstacleSet(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)), shapes_(checked_shapes(obstacles_)) {
  for (const Obstacle& obstacle : obstacles_) {
    before_.push_back(obstacle.motion.pose(obstacle.rest_pose, 0.0));
    into_before_.push_back(before_.back().inverse());
    max_thickness_ = std::max(max_thickness_, obstacle.material.thickness);
  }
  after_ = before_;
  into_after_ = into_before_;
  magnitude_.resize(obstacles_.size());
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    moves_ = moves_ || changes(k);
    update_magnitude(k);
  }
  broad_phase_ = std::make_unique<BroadPhase>(obstacles_, shapes_, after_);
}

void ObstacleSet::set_material(Index k, const ContactMaterial& material) {
  obstacles_[static_cast<std::size_t>(k)].material = material;
  max_thickness_ = 0.0;
  for (const Obstacle& obstacle : obstacles_) max_thickness_ = std::max(max_thickness_, obstacle.material.thickness);
}

void ObstacleSet::set_interval(double t, double t_end) {
  if (!moves_) return;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    if (shapes_[k]->deforms()) shapes_[k]->set_interval(t, t_end);
    if (!obstacles_[k].motion.moves()) continue;
    before_[k] = obstacles_[k].motion.pose(obstacles_[k].rest_pose, t);
    after_[k] = obstacles_[k].motion.pose(obstacles_[k].rest_pose, t_end);
    into_before_[k] = before_[k].inverse();
    into_after_[k] = after_[k].inverse();
    update_magnitude(k);
  }
  broad_phase_->move(after_);
}

void ObstacleSet::update_magnitude(std::size_t k) {
  magnitude_[k] = shapes_[k]->magnitude() + std::max(largest(before_[k].translation()), largest(after_[k].translation()));
}

double ObstacleSet::clearance(Index k, const Vector3& from, const Vector3& to) const {
  return kClearance * std::max({magnitude_[static_cast<std::size_t>(k)], largest(from), largest(to)});
}

double ObstacleSet::max_clearance(const Box3& box) const {
  const double of_obstacles = magnitude_.empty() ? 0.0 : *std::max_element(magnitude_.begin(), magnitude_.end());
  return kClearance * std::max({of_obstacles, largest(box.min()), largest(box.max())});
}

Vector3 ObstacleSet::moved_position(Index k, const Vector3& from) const {
  if (rests(k)) return from;
  const Vector3 before = local_before(k, from);
  const auto moved = shape(k).moved_element({.x = {before}, .count = 1}, 0.0);
  return after(k) * (moved ? moved->corners.x[0] : Vector3(before + shape(k).displacement(before)));
}

Vector3 ObstacleSet::drift(Index k, const Vector3& position, double t, double t_end) const {
  if (!shape(k).deforms()) return Vector3::Zero();
  return after(k).linear() * shape(k).displacement(local(k, position), t, t_end);
}

double ObstacleSet::max_displacement(const Points& positions) const {
  if (!moves_) return 0.0;
  const Box3 box = finite_bounds(positions, 0, static_cast<Index>(positions.cols()));
  if (box.isEmpty()) return 0.0;
  double farthest = 0.0;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    if (!changes(k)) continue;
    const RigidTransform motion = after_[k] * into_before_[k];
    const double at_centre = (motion * box.center() - box.center()).norm();
    const double around = (motion.linear() - Matrix3::Identity()).norm() * 0.5 * box.diagonal().norm();
    farthest = std::max(farthest, at_centre + around + shapes_[k]->largest_displacement());
  }
  return farthest;
}

}  // namespace sprung
