#include "simulation/step/pin_paths.h"

#include "base/problem_list.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace sprung {
namespace {

void check_obstacles(const SpringNetwork& network, std::size_t count) {
  ProblemList problems;
  for (std::size_t p = 0; p < network.pins.size(); ++p) {
    const Index obstacle = network.pins[p].obstacle;
    if (obstacle == kNone || (obstacle >= 0 && static_cast<std::size_t>(obstacle) < count)) continue;
    problems.add(entry_key("pins", p) + ".obstacle", std::to_string(obstacle),
                 "must be the number of an obstacle; there are " + std::to_string(count), "count obstacles from 0");
  }
  problems.throw_if_any();
}

const MeshSequence* sequence_of(const Obstacle& obstacle) {
  return obstacle.deforms() ? std::get<SequenceGeometry>(obstacle.geometry).sequence.get() : nullptr;
}

const PinGrip* find(const std::vector<PinGrip>& grips, Index particle) {
  const auto found = std::ranges::lower_bound(grips, particle, {}, &PinGrip::particle);
  return found != grips.end() && found->particle == particle ? &*found : nullptr;
}

}  // namespace

RigidTransform PinPaths::Path::origin() const { return RigidTransform(Eigen::Translation3d(pin->origin)); }

RigidTransform PinPaths::Path::pose(double time) const {
  return motion().pose(obstacle != nullptr ? obstacle->rest_pose : origin(), time);
}

/// Where a path has its particles at one time.
class PinPaths::Placing {
 public:
  Placing(const Path& path, double time) : path_(path), time_(time), pose_(path.pose(time)) {}

  Vector3 operator()(const Held& held) {
    if (held.begin == time_) return held.start;  // without the rounding of poses
    if (path_.sequence != nullptr) return pose_ * anchored_position(*path_.sequence, held.surface, time_);
    if (!motion_ || held.begin != begin_) {
      begin_ = held.begin;
      motion_ = pose_ * (begin_ ? path_.pose(*begin_) : path_.origin()).inverse();
    }
    return *motion_ * held.start;
  }

 private:
  const Path& path_;
  double time_;
  RigidTransform pose_;
  std::optional<double> begin_;
  std::optional<RigidTransform> motion_;  ///< since begin_
};

PinPaths::PinPaths(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, double step_length)
    : network_(network), obstacles_(obstacles), step_length_(step_length) {
  check_obstacles(network, obstacles.size());
}

void PinPaths::find_paths() {
  paths_.clear();
  for (std::size_t p = 0; p < network_.pins.size(); ++p) {
    const Pin& pin = network_.pins[p];
    if (!pin.moves() || network_.activity.phases[p] != PinPhase::holding) continue;
    Path path{.pin = &pin, .held = held_particles(network_, p)};
    if (pin.obstacle != kNone) {
      path.obstacle = &obstacles_[static_cast<std::size_t>(pin.obstacle)];
      path.sequence = sequence_of(*path.obstacle);
    }
    paths_.push_back(std::move(path));
  }
}

bool PinPaths::register_pins(SimulationState& state) {
  find_paths();
  std::vector<PinGrip> all;
  bool is_new = false;
  for (Path& path : paths_) {
    path.particles.clear();
    if (!path.needs_grips() && !has_grips(path, state)) {
      const std::optional<double> begin = path.obstacle != nullptr ? std::optional(0.0) : std::nullopt;
      for (const Index i : path.held) path.particles.push_back({i, begin, network_.positions.col(i), {}});
      continue;
    }
    for (const PinGrip& grip : grips_of(path, state, is_new)) {
      Held held{grip.particle, grip.time, grip.position, {}};
      if (path.sequence != nullptr) {
        const double time = grip.time;
        held.surface = anchored(*path.sequence, grip.triangle, time, path.pose(time).inverse() * grip.position);
      }
      path.particles.push_back(held);
      all.push_back(grip);
    }
  }
  std::ranges::sort(all, {}, &PinGrip::particle);
  state.grips = std::move(all);
  return is_new;
}

/// Whether the state has grips of the pin: see StartState.
bool PinPaths::has_grips(const Path& path, const SimulationState& state) {
  return std::ranges::any_of(path.held, [&](Index i) {
    const PinGrip* known = find(state.grips, i);
    return known != nullptr && known->from == path.pin->from;
  });
}

/// Those of the state that this pin made, and new ones for its other particles.
std::vector<PinGrip> PinPaths::grips_of(const Path& path, const SimulationState& state, bool& is_new) const {
  const double from = path.pin->from;
  const std::vector<TimedPose>& steered = path.motion().poses;
  const bool later = from > 0.0 || !steered.empty();
  std::vector<PinGrip> grips;
  std::vector<std::size_t> added;
  std::vector<Vector3> points;  // of those, in the obstacle's frame
  for (const Index i : path.held) {
    const PinGrip* known = find(state.grips, i);
    if (known != nullptr && known->from == from && (steered.empty() || known->time >= steered.front().time)) {
      grips.push_back(*known);
      if (path.sequence == nullptr || known->triangle != kNone) continue;
    } else {
      const double time = later ? steps_done(state) * step_length_ : 0.0;
      const Vector3 position = later ? state.x.col(i) : network_.positions.col(i);
      grips.push_back({.particle = i, .from = from, .time = time, .position = position});
    }
    added.push_back(grips.size() - 1);
    points.push_back(path.pose(grips.back().time).inverse() * grips.back().position);
  }
  if (added.empty()) return grips;
  is_new = true;
  if (path.sequence == nullptr) return grips;
  const double time = grips[added.front()].time;
  const std::vector<Index> triangles = nearest_triangles(*path.sequence, time, points);
  for (std::size_t k = 0; k < added.size(); ++k) grips[added[k]].triangle = triangles[k];
  return grips;
}

double PinPaths::move(double time, double dt, SimulationState& state) const {
  double fastest = 0.0;
  for (const Path& path : paths_) {
    Placing now(path, time);
    Placing next(path, time + dt);
    for (const Held& held : path.particles) {
      const Index i = held.particle;
      state.x.col(i) = now(held);
      state.v.col(i) = (next(held) - state.x.col(i)) / dt;
      fastest = std::max(fastest, state.v.col(i).norm());
    }
  }
  return fastest;
}

void PinPaths::set_last_velocities(double time, double dt, Points& velocities) const {
  for (const Path& path : paths_) {
    Placing now(path, time);
    Placing before(path, time - dt);
    for (const Held& held : path.particles) {
      if (time - 0.5 * dt > held.begin.value_or(0.0)) velocities.col(held.particle) = (now(held) - before(held)) / dt;
    }
  }
}

}  // namespace sprung
