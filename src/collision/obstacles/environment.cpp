#include "collision/obstacles/environment.h"

#include "collision/core/block_bounds.h"
#include "collision/obstacles/obstacle_set.h"
#include "collision/obstacles/vertex_contact.h"

#include <algorithm>
#include <cmath>

namespace sprung {

struct Environment::Implementation {
  ObstacleSet set;
  Interval interval{};
};

Environment::Environment(std::vector<Obstacle> obstacles)
    : implementation_(new Implementation{ObstacleSet(std::move(obstacles))}) {}

Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

const std::vector<Obstacle>& Environment::obstacles() const { return implementation_->set.obstacles(); }

const ObstacleSet& Environment::set() const { return implementation_->set; }

void Environment::set_interval(double t, double t_end) {
  implementation_->interval = {t, t_end};
  implementation_->set.set_interval(t, t_end);
}

void Environment::set_material(Index obstacle, const ContactMaterial& material) {
  implementation_->set.set_material(obstacle, material);
}

Environment::Interval Environment::interval() const { return implementation_->interval; }

const RigidTransform& Environment::pose_before(Index obstacle) const { return implementation_->set.before(obstacle); }
const RigidTransform& Environment::pose_after(Index obstacle) const { return implementation_->set.after(obstacle); }

Vector3 Environment::surface_velocity(Index obstacle, const Vector3& position, double time, double dt) const {
  const ObstacleSet& set = implementation_->set;
  const auto& [name, geometry, rest_pose, motion, material] = set.obstacle(obstacle);
  if (!motion.moves() && !set.shape(obstacle).deforms()) return Vector3::Zero();
  const Vector3 moved = motion.pose(rest_pose, time + dt) * (motion.pose(rest_pose, time).inverse() * position);
  return (moved - position + set.drift(obstacle, position, time, time + dt)) / dt;
}

std::vector<Contact> Environment::contacts(const VertexPaths& paths) const {
  const ObstacleSet& set = implementation_->set;
  const auto count = static_cast<Index>(paths.after.cols());
  if (set.obstacles().empty()) return {};
  const double displacement = set.max_displacement(paths.before);

  return collect_from_blocks<Contact>(count, [&](Index begin, Index end, std::vector<Contact>& contacts) {
    const Box3 box = finite_bounds(paths.before, begin, end).merged(finite_bounds(paths.after, begin, end));
    if (box.isEmpty()) return;
    const double gap = paths.thickness.segment(begin, end - begin).maxCoeff() + set.max_thickness();
    const double reach = std::max(gap, set.max_clearance(box)) + paths.margin;
    std::vector<Index> near;
    set.find_near(grown(box, reach + displacement), near);
    if (near.empty()) return;
    for (Index i = begin; i < end; ++i) {
      const Vector3 before = paths.before.col(i);
      const Vector3 after = paths.after.col(i);
      if (!before.allFinite() || !after.allFinite()) continue;
      for (const Index k : near) {
        const auto contact = find_contact(set, k, {i, before, after, paths.thickness[i], paths.margin});
        if (contact) contacts.push_back(*contact);
      }
    }
  });
}

std::optional<double> Environment::min_distance(const Points& positions, double radius) const {
  const ObstacleSet& set = implementation_->set;
  const std::vector<double> distances =
      collect_from_blocks<double>(static_cast<Index>(positions.cols()), [&](Index begin, Index end, std::vector<double>& found) {
        const Box3 box = finite_bounds(positions, begin, end);
        if (box.isEmpty()) return;
        std::vector<Index> near;
        set.find_near(grown(box, radius), near);
        double smallest = radius;
        for (Index i = begin; i < end; ++i) {
          for (const Index k : near) {
            const Vector3 p = set.local(k, positions.col(i));
            if (!p.allFinite()) continue;
            if (const auto surface = set.shape(k).nearest(p, smallest)) smallest = std::min(smallest, surface->distance);
          }
        }
        if (smallest < radius) found.push_back(smallest);
      });
  if (distances.empty()) return std::nullopt;
  return *std::min_element(distances.begin(), distances.end());
}

}  // namespace sprung
