#include "simulation/sleep/islands.h"

#include "collision/core/block_bounds.h"
#include "collision/obstacles/obstacle_set.h"
#include "dynamics/attachments/attachments.h"
#include "geometry/mesh/union_find.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sprung {
namespace {

// An obstacle that turns farther in a step may reach anything near it [degrees].
constexpr double kMaxTurn = 45.0;

/// An upper bound of the displacement [m] of any point of the box by a motion.
double displacement(const RigidTransform& motion, const Box3& box) {
  const double of_centre = (motion * box.center() - box.center()).norm();
  return of_centre + (motion.linear() - Matrix3::Identity()).norm() * 0.5 * box.diagonal().norm();
}

}  // namespace

Islands::Islands(const SpringNetwork& network, const Environment& environment, double step, double gravity)
    : network_(network), environment_(environment), step_(step), gravity_(gravity), ends_(network.bodies.size(), 0.0) {
  for (const std::vector<Pin>* pins : {&network.pins, &network.later_pins}) {
    for (const Pin& pin : *pins) note(pin);
  }
  for (const Attachment& attachment : network.attachments) note(attachment);
  std::ranges::sort(joined_);
  joined_.erase(std::unique(joined_.begin(), joined_.end()), joined_.end());
}

void Islands::note(const Pin& pin) {
  const double until = std::isfinite(pin.until) ? pin.until + step_ : 0.0;  // rounded to a step
  const double motion = pin.obstacle != kNone ? end_of_obstacle(pin.obstacle) : pin.motion.end();
  const double end = std::max({pin.from > 0.0 ? pin.from + step_ : 0.0, until, std::min(motion, pin.until)});
  for (const Index particle : pin.particles) ends_[body_of(particle)] = std::max(ends_[body_of(particle)], end);
}

void Islands::note(const Attachment& attachment) {
  double end = end_of_changes(attachment, step_);
  std::vector<std::size_t> bodies;
  for (const Index particle : attachment.particles) bodies.push_back(body_of(particle));
  if (const auto* ends = std::get_if<ParticleEnds>(&attachment.second)) {
    for (const Index particle : ends->particles) bodies.push_back(body_of(particle));
  } else if (const auto* surface = std::get_if<SurfaceEnd>(&attachment.second)) {
    bodies.push_back(static_cast<std::size_t>(surface->body));
  } else {
    end = std::max(end, end_of_obstacle(std::get<ObstacleEnd>(attachment.second).obstacle));
  }
  for (const std::size_t body : bodies) {
    ends_[body] = std::max(ends_[body], end);
    joined_.emplace_back(bodies.front(), body);
  }
}

std::size_t Islands::body_of(Index particle) const {
  return static_cast<std::size_t>(&network_.body_of(particle) - network_.bodies.data());
}

double Islands::end_of_obstacle(Index obstacle) const {
  const Obstacle& followed = environment_.obstacles()[static_cast<std::size_t>(obstacle)];
  return followed.deforms() ? std::numeric_limits<double>::infinity() : followed.motion.end();
}

Islands::Found Islands::find(const SimulationState& state) const {
  const std::vector<Body>& bodies = network_.bodies;
  Found found;
  for (const Body& body : bodies) found.boxes.push_back(box_in_step(body, state));
  const auto& boxes = found.boxes;
  UnionFind sets(static_cast<Index>(bodies.size()));
  for (const auto& [a, b] : joined_) sets.join(static_cast<Index>(a), static_cast<Index>(b));
  std::vector<std::size_t> by_x(bodies.size());
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::ranges::sort(by_x, {}, [&](std::size_t b) { return std::pair(boxes[b].min().x(), b); });
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    const Box3& box = boxes[by_x[i]];
    for (std::size_t j = i + 1; j < by_x.size() && boxes[by_x[j]].min().x() <= box.max().x(); ++j) {
      if (!bodies[by_x[i]].contact.others || !bodies[by_x[j]].contact.others || !box.intersects(boxes[by_x[j]])) continue;
      sets.join(static_cast<Index>(by_x[i]), static_cast<Index>(by_x[j]));
    }
  }
  for (Index b = 0; b < static_cast<Index>(bodies.size()); ++b) found.islands.push_back(sets.root(b));
  return found;
}

std::vector<char> Islands::driven(const Found& found, double time) const {
  std::vector<char> driven;
  for (std::size_t b = 0; b < ends_.size(); ++b) driven.push_back(time < ends_[b] || is_reached(found.boxes[b], time) ? 1 : 0);
  return driven;
}

std::vector<char> with_islands(const std::vector<char>& marked, const std::vector<Index>& islands) {
  std::vector<char> has_marked(marked.size(), 0);  // by island
  for (std::size_t b = 0; b < marked.size(); ++b) {
    if (marked[b] != 0) has_marked[islands[b]] = 1;
  }
  std::vector<char> result;
  for (const Index island : islands) result.push_back(has_marked[island]);
  return result;
}

Box3 Islands::box_in_step(const Body& body, const SimulationState& state) const {
  const auto speeds = state.v.middleCols(body.first_particle, body.particle_count).colwise().norm();
  const double farthest = body.asleep || body.particle_count == 0 ? 0.0 : step_ * (speeds.maxCoeff() + step_ * gravity_);
  return grown(finite_bounds(state.x, body.first_particle, body.first_particle + body.particle_count),
               body.material.thickness + farthest);
}

/// A box that a half-space contains is in its reach too.
bool Islands::is_reached(const Box3& box, double time) const {
  std::vector<Index> found;
  for (std::size_t k = 0; k < environment_.obstacles().size(); ++k) {
    const Obstacle& obstacle = environment_.obstacles()[k];
    if (end_of_obstacle(static_cast<Index>(k)) <= time) continue;
    if (obstacle.deforms() || obstacle.motion.turn(time, time + step_) > kMaxTurn) return true;
    const RigidTransform now = obstacle.motion.pose(obstacle.rest_pose, time);
    const RigidTransform then = obstacle.motion.pose(obstacle.rest_pose, time + step_);
    environment_.set().find_near(grown(box, obstacle.material.thickness + displacement(now * then.inverse(), box)), found);
    if (std::ranges::binary_search(found, static_cast<Index>(k))) return true;
  }
  return false;
}

}  // namespace sprung
