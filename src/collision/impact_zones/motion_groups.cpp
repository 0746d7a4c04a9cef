#include "collision/impact_zones/motion_groups.h"

#include "base/sort_unique.h"
#include "collision/impact_zones/group_motion.h"

#include <algorithm>

namespace sprung {

MotionGroups::MotionGroups(const Points& before, const Points& targets, const ParticleMotions& motions,
                           const ParticleDisplacements& displacements)
    : before_(before),
      targets_(targets),
      motions_(motions),
      displacements_(displacements),
      parent_(static_cast<std::size_t>(before.cols()), kNone),
      locked_(parent_.size(), 0),
      number_(parent_.size(), kNone) {}

bool MotionGroups::unite(std::span<const Index> particles) {
  Index first = kNone;
  bool changed = false;
  bool locked = false;
  for (const Index i : particles) {
    if (is_fixed(motions_, i)) continue;
    if (!contains(i)) {
      parent_[static_cast<std::size_t>(i)] = i;
      particles_.push_back(i);
      changed = true;
    }
    const Index other = root(i);
    locked = locked || locked_[static_cast<std::size_t>(other)] != 0;
    if (first == kNone) first = other;
    if (other == first) continue;
    changed = true;
    const auto [low, high] = std::minmax(first, other);
    parent_[static_cast<std::size_t>(high)] = low;
    first = low;
  }
  if (first == kNone) return false;
  char& lock = locked_[static_cast<std::size_t>(first)];
  for (const Index i : particles) {
    if (!is_fixed(motions_, i) || is_fixed_by(first, i)) continue;
    fixed_by_.push_back({first, i});
    changed = true;
  }
  if (!changed && lock == 0) {
    lock = 1;
    return true;
  }
  lock = locked ? 1 : 0;
  return changed;
}

bool MotionGroups::is_fixed_by(Index root_particle, Index pin) const {
  return std::any_of(fixed_by_.begin(), fixed_by_.end(),
                     [&](const FixedBy& entry) { return entry.pin == pin && root(entry.particle) == root_particle; });
}

void MotionGroups::find_motions() {
  number_groups();
  const std::vector<std::vector<Index>> pins = pins_of_groups();
  find_means(pins);
  apply_blocked(pins);
  apply_rigid_pins(pins);
}

void MotionGroups::number_groups() {
  groups_.clear();
  for (const Index i : particles_) {
    if (parent_[static_cast<std::size_t>(i)] != i) continue;
    number_[static_cast<std::size_t>(i)] = static_cast<Index>(groups_.size());
    groups_.push_back({.fraction = locked_[static_cast<std::size_t>(i)] != 0 ? 0.0 : 1.0});
  }
  for (const Index i : particles_) number_[static_cast<std::size_t>(i)] = number_[static_cast<std::size_t>(root(i))];
}

void MotionGroups::find_means(const std::vector<std::vector<Index>>& pins) {
  struct Sum {
    Vector3 motion = Vector3::Zero();
    double squares = 0.0;
    double count = 0.0;
    int rank = 0;  ///< of the rule that the sum belongs to: the highest rank wins
  };
  std::vector<Sum> sums(groups_.size());
  const auto add = [&](std::size_t number, const Vector3& motion, int rank) {
    Sum& sum = sums[number];
    if (rank > sum.rank) sum = {.rank = rank};
    if (rank < sum.rank) return;
    sum.motion += motion;
    sum.squares += motion.squaredNorm();
    sum.count += 1.0;
  };
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    for (const Index pin : pins[k]) add(k, targets_.col(pin) - before_.col(pin), 3);
  }
  const std::vector<ParticleDisplacement>& moved = displacements_.moved;
  for (const Index i : particles_) {
    const auto number = static_cast<std::size_t>(group(i));
    const auto found =
        std::lower_bound(moved.begin(), moved.end(), i, [](const ParticleDisplacement& a, Index b) { return a.particle < b; });
    if (found != moved.end() && found->particle == i) {
      add(number, found->motion, 2);
    } else {
      add(number, targets_.col(i) - before_.col(i), 1);
    }
  }
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const Sum& sum = sums[k];
    const Vector3 mean = sum.motion / sum.count;
    const double common2 = mean.squaredNorm();
    const double spread2 = sum.squares / sum.count - common2;
    const double shared = sum.rank > 1 ? 1.0 : common2 > 0.0 ? std::max(0.0, 1.0 - spread2 / common2) : 0.0;
    groups_[k].motion.translation() = shared * mean;
  }
}

std::vector<std::vector<Index>> MotionGroups::pins_of_groups() const {
  std::vector<std::vector<Index>> pins(groups_.size());
  for (const FixedBy& entry : fixed_by_) pins[static_cast<std::size_t>(group(entry.particle))].push_back(entry.pin);
  for (std::vector<Index>& of_group : pins) sort_unique(of_group);
  return pins;
}

void MotionGroups::apply_blocked(const std::vector<std::vector<Index>>& pins) {
  if (displacements_.blocked.empty()) return;
  std::vector<std::vector<BlockedVertex>> blocked(groups_.size());
  for (const BlockedVertex& vertex : displacements_.blocked) {
    const Index k = group(vertex.particle);
    if (k != kNone && pins[static_cast<std::size_t>(k)].empty()) blocked[static_cast<std::size_t>(k)].push_back(vertex);
  }
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    if (blocked[k].empty()) continue;
    groups_[k] = {.motion = common_motion(blocked[k]), .fraction = 0.0, .rotates = true, .with_obstacle = true};
  }
}

void MotionGroups::apply_rigid_pins(const std::vector<std::vector<Index>>& pins) {
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    if (pins[k].empty() || groups_[k].fraction > 0.0) continue;
    std::vector<PinDisplacement> displacements;
    for (const Index pin : pins[k]) displacements.push_back({before_.col(pin), targets_.col(pin)});
    const auto motion = rigid_motion_of(displacements);
    if (motion) groups_[k] = {.motion = AffineTransform(*motion), .fraction = 0.0, .rotates = true};
  }
}

MovedPlane MotionGroups::moved(Index group, const Vector3& normal) const {
  if (group == kNone || !groups_[static_cast<std::size_t>(group)].rotates) return {normal, normal, normal};
  return moved_plane(normal, groups_[static_cast<std::size_t>(group)].motion.linear());
}

Vector3 MotionGroups::start(Index particle) const {
  if (!contains(particle)) return targets_.col(particle);
  return groups_[static_cast<std::size_t>(group(particle))].motion * before_.col(particle);
}

bool MotionGroups::any_rotates() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const Group& group) { return group.rotates; });
}

bool MotionGroups::moves_to_target(Index group, Index pin, double miss) const {
  if (group == kNone || fraction(group) > 0.0) return false;
  const Vector3 end = groups_[static_cast<std::size_t>(group)].motion * before_.col(pin);
  return (end - targets_.col(pin)).norm() <= miss;
}

Vector3 MotionGroups::end(Index particle) const {
  if (!contains(particle)) return targets_.col(particle);
  const Vector3 from = start(particle);
  return from + fraction(group(particle)) * (targets_.col(particle) - from);
}

void MotionGroups::limit_fraction(Index group, double fraction) {
  double& limited = groups_[static_cast<std::size_t>(group)].fraction;
  limited = std::min(limited, fraction);
}

Index MotionGroups::root(Index particle) const {
  Index i = particle;
  while (parent_[static_cast<std::size_t>(i)] != i) i = parent_[static_cast<std::size_t>(i)];
  return i;
}

}  // namespace sprung
