#include "simulation/sleep/surroundings.h"

#include "base/sort_unique.h"
#include "collision/core/block_bounds.h"
#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/attachments/attachments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sprung {
namespace {

// An obstacle that turns farther in a step may reach anything near it [degrees].
constexpr double kMaxRotation = 45.0;

/// An upper bound of the displacement [m] of any point of the box by a motion.
double displacement(const RigidTransform& motion, const Box3& box) {
  const double of_centre = (motion * box.center() - box.center()).norm();
  return of_centre + (motion.linear() - Matrix3::Identity()).norm() * 0.5 * box.diagonal().norm();
}

}  // namespace

Surroundings::Surroundings(const SpringNetwork& network, const ObstacleSet& obstacles, const SleepGroups& groups, double step,
                           const Vector3& gravity)
    : network_(network), obstacles_(obstacles), groups_(groups), step_(step), gravity_(gravity), ends_(groups.groups.size(), 0.0) {
  note_motions();
}

void Surroundings::note_motions() {
  std::ranges::fill(ends_, 0.0);
  attached_.clear();
  for (std::size_t p = 0; p < network_.pins.size(); ++p) note(p);
  for (const Attachment& attachment : network_.attachments) note(attachment);
  sort_unique(attached_);
}

void Surroundings::note(std::size_t number) {
  const Pin& pin = network_.pins[number];
  const double until = std::isfinite(pin.until) ? pin.until + step_ : 0.0;  // rounded to a step
  const double motion = pin.obstacle != kNone ? end_of_obstacle(pin.obstacle) : pin.motion.end();
  const double end = std::max({pin.from > 0.0 ? pin.from + step_ : 0.0, until, std::min(motion, pin.until)});
  const bool waits = network_.activity.phases[number] == PinPhase::waiting;
  for (const Index p : groups_of(waits ? pin.particles : held_particles(network_, number))) ends_[p] = std::max(ends_[p], end);
}

void Surroundings::note(const Attachment& attachment) {
  double end = end_of_changes(attachment, step_);
  const std::vector<Index> firsts = groups_of(attachment.particles);
  std::vector<Index> seconds;
  if (const auto* ends = std::get_if<ParticleEnds>(&attachment.second)) {
    seconds = groups_of(ends->particles);
  } else if (const auto* surface = std::get_if<SurfaceEnd>(&attachment.second)) {
    seconds = groups_of_body(static_cast<std::size_t>(surface->body));
  } else {
    end = std::max(end, end_of_obstacle(std::get<ObstacleEnd>(attachment.second).obstacle));
  }
  for (const Index a : firsts) ends_[a] = std::max(ends_[a], end);
  for (const Index b : seconds) {
    ends_[b] = std::max(ends_[b], end);
    for (const Index a : firsts) {
      if (a != b) attached_.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
}

/// Ascending, each once.
std::vector<Index> Surroundings::groups_of(const std::vector<Index>& particles) const {
  std::vector<Index> found;
  for (const Index particle : particles) found.push_back(groups_.group_of[particle]);
  sort_unique(found);
  return found;
}

std::vector<Index> Surroundings::groups_of_body(std::size_t body) const {
  std::vector<Index> found;
  for (Index p = 0; p < groups_.count(); ++p) {
    if (groups_.groups[p].body == body) found.push_back(p);
  }
  return found;
}

double Surroundings::end_of_obstacle(Index obstacle) const {
  const Obstacle& followed = obstacles_.obstacle(obstacle);
  return followed.deforms() ? std::numeric_limits<double>::infinity() : followed.motion.end();
}

Surroundings::Found Surroundings::find(const SimulationState& state) const {
  Found found{.boxes = {}, .pairs = groups_.adjacent};
  found.pairs.insert(found.pairs.end(), attached_.begin(), attached_.end());
  Box3 all;
  for (const SleepGroup& group : groups_.groups) {
    found.boxes.push_back(box_in_step(group, state));
    all.extend(found.boxes.back());
  }
  const auto& boxes = found.boxes;
  Index axis = 0;  // along which the boxes are swept
  if (!all.isEmpty()) all.sizes().maxCoeff(&axis);
  std::vector<Index> order(boxes.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, {}, [&](Index p) { return std::pair(boxes[p].min()[axis], p); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index a = order[i];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].min()[axis] <= boxes[a].max()[axis]; ++j) {
      const Index b = order[j];
      if (!may_collide(groups_.groups[a], groups_.groups[b]) || !boxes[a].intersects(boxes[b])) continue;
      found.pairs.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  return found;
}

bool Surroundings::may_collide(const SleepGroup& a, const SleepGroup& b) const {
  const BodyContact& first = network_.bodies[a.body].contact;
  return a.body == b.body ? first.self : first.others && network_.bodies[b.body].contact.others;
}

std::vector<char> Surroundings::driven(const Found& found, double time) const {
  const ObstacleFrame now(obstacles_, time, time);
  std::vector<char> driven;
  for (std::size_t p = 0; p < ends_.size(); ++p) driven.push_back(time < ends_[p] || is_reached(found.boxes[p], now) ? 1 : 0);
  return driven;
}

std::vector<char> Surroundings::beside_obstacles(const Found& found, double time) const {
  const ObstacleFrame now(obstacles_, time, time);
  double thickest = 0.0;
  for (const Obstacle& obstacle : obstacles_.obstacles()) thickest = std::max(thickest, obstacle.material.thickness);
  std::vector<char> beside;
  std::vector<Index> near;
  for (const Box3& box : found.boxes) {
    now.find_near(grown(box, thickest), near);
    beside.push_back(near.empty() ? 0 : 1);
  }
  return beside;
}

/// A face with a waking corner moves; all others of a sleeping group are still.
Box3 Surroundings::box_in_step(const SleepGroup& group, const SimulationState& state) const {
  double farthest = 0.0;
  for (const Index i : group.reached) {
    if (!network_.is_asleep(i)) farthest = std::max(farthest, step_ * (state.v.col(i).norm() + step_ * gravity_.norm()));
  }
  return grown(finite_bounds(state.x, group.reached), network_.bodies[group.body].material.thickness + farthest);
}

/// A box that a half-space contains is in its reach too.
bool Surroundings::is_reached(const Box3& box, const ObstacleFrame& now) const {
  const double time = now.end();
  std::vector<Index> found;
  for (Index k = 0; k < static_cast<Index>(obstacles_.obstacles().size()); ++k) {
    const Obstacle& obstacle = obstacles_.obstacle(k);
    if (end_of_obstacle(k) <= time) continue;
    if (obstacle.deforms() || obstacle.motion.rotation(time, time + step_) > kMaxRotation) return true;
    const RigidTransform then = obstacle.motion.pose(obstacle.rest_pose, time + step_);
    now.find_near(grown(box, obstacle.material.thickness + displacement(now.after(k) * then.inverse(), box)), found);
    if (std::ranges::binary_search(found, k)) return true;
  }
  return false;
}

}  // namespace sprung
