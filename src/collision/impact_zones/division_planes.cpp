#include "collision/impact_zones/division_planes.h"

#include "base/parallel.h"
#include "collision/core/block_bounds.h"
#include "collision/core/contact.h"
#include "collision/impact_zones/group_motion.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

// How far a pin may end from where its group's motion puts it, as a fraction of its pair's gap. Along linear trajectories a
// rotation by less than a right angle keeps 0.7 of a gap, and the strain of a group with blocked vertices half of it, so that a
// quarter is left for pins.
constexpr double kMaxPinError = 0.25;

constexpr Index kPairsPerTask = 2048;

std::vector<DivisionPlanes::Bound> sorted(const std::vector<DivisionPlanes::Bound>& bounds, Index particles) {
  std::vector<std::size_t> next(static_cast<std::size_t>(particles) + 1, 0);
  for (const DivisionPlanes::Bound& bound : bounds) ++next[static_cast<std::size_t>(bound.particle) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<DivisionPlanes::Bound> result(bounds.size());
  for (const DivisionPlanes::Bound& bound : bounds) result[next[static_cast<std::size_t>(bound.particle)]++] = bound;
  return result;
}

}  // namespace

DivisionPlanes::DivisionPlanes(const Points& before, const Points& targets, const ParticleMotions& motions,
                               const ParticleDisplacements& displacements, double kept)
    : before_(before),
      targets_(targets),
      motions_(motions),
      groups_(before, targets, motions, displacements),
      ends_(targets),
      tolerance_{.thickness_kept = kept, .clearance = kClearance * before.cwiseAbs().maxCoeff()} {}

bool DivisionPlanes::constrain(std::vector<ContactStencil>& pairs) {
  bool changed = false;
  crossing_.clear();
  for (const Index k : find_crossing(pairs)) {
    const ContactStencil& pair = pairs[static_cast<std::size_t>(k)];
    changed = groups_.unite({pair.particles.data(), static_cast<std::size_t>(pair.count())}) || changed;
    crossing_.insert(crossing_.end(), pair.particles.begin(), pair.particles.begin() + pair.count());
  }
  if (!changed) return false;
  groups_.find_motions();
  limit_groups(pairs);
  for (const Index i : groups_.particles()) ends_.col(i) = groups_.end(i);
  return true;
}

void DivisionPlanes::renew_normals(std::vector<ContactStencil>& pairs) const {
  parallel_chunks(static_cast<Index>(pairs.size()), kPairsPerTask, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      ContactStencil& pair = pairs[static_cast<std::size_t>(k)];
      if (!(heights_at(pair, before_).gap() > 0.0)) pair.normal = separating_direction(pair, before_);
    }
  });
}

std::vector<Index> DivisionPlanes::find_crossing(std::vector<ContactStencil>& pairs) const {
  const auto count = static_cast<Index>(pairs.size());
  return collect_from_chunks<Index>(count, kPairsPerTask, [&](Index begin, Index end, std::vector<Index>& crossing) {
    for (Index k = begin; k < end; ++k) {
      ContactStencil& pair = pairs[static_cast<std::size_t>(k)];
      if (!(heights_at(pair, ends_).gap() < tolerance_.least())) continue;
      pair.normal = separating_direction(pair, before_);
      if (crosses(pair) && !is_fixed_rigidly(pair)) crossing.push_back(k);
    }
  });
}

bool DivisionPlanes::is_fixed_rigidly(const ContactStencil& pair) const {
  std::vector<PinDisplacement> pins;
  for (int k = 0; k < pair.count(); ++k) {
    const Index i = pair.particles[static_cast<std::size_t>(k)];
    if (!is_fixed(motions_, i)) return false;
    pins.push_back({before_.col(i), targets_.col(i)});
  }
  const auto motion = rigid_motion_of(pins);
  const double gap = heights_at(pair, before_).gap();
  return motion && std::ranges::all_of(pins, [&](const PinDisplacement& pin) {
           return (*motion * pin.from - pin.to).norm() <= kMaxPinError * gap;
         });
}

std::vector<Index> DivisionPlanes::moved_with_obstacle() const {
  std::vector<Index> moved = groups_.particles();
  std::erase_if(moved, [&](Index i) { return !groups_.moves_with_obstacle(groups_.group(i)); });
  return moved;
}

/// Whether the sides end with too small a gap. Sides that touched at the step's begin have no plane to keep. Sides that move
/// rigidly need none.
bool DivisionPlanes::crosses(const ContactStencil& pair) const {
  const double begun = heights_at(pair, before_).gap();
  if (!(begun > 0.0)) return false;
  const Index group = group_of(pair, begun);
  const bool has_fixed = pair.any_of([&](Index i) { return is_fixed(motions_, i); });
  if (group != kNone && groups_.fraction(group) == 0.0 && !has_fixed) return false;
  const double end = heights_at(moved(pair, group), ends_).gap();
  return end < tolerance_.needed(begun);
}

ContactStencil DivisionPlanes::moved(ContactStencil pair, Index group) const {
  pair.normal = groups_.moved(group, pair.normal).end.normalized();
  return pair;
}

Index DivisionPlanes::group_of(const ContactStencil& pair, double gap) const {
  Index group = kNone;
  for (int k = 0; k < pair.count(); ++k) group = std::max(group, groups_.group(pair.particles[static_cast<std::size_t>(k)]));
  const auto is_of = [&](Index i) {
    return groups_.group(i) == group || (is_fixed(motions_, i) && groups_.moves_to_target(group, i, kMaxPinError * gap));
  };
  return std::all_of(pair.particles.begin(), pair.particles.begin() + pair.count(), is_of) ? group : kNone;
}

/// The gap of a group's pair is concave in the fraction, so its linear interpolation is a lower bound.
void DivisionPlanes::limit_groups(const std::vector<ContactStencil>& pairs) {
  for (const ContactStencil& pair : pairs) {
    Index group = kNone;
    bool inner = true;
    for (int k = 0; k < pair.count(); ++k) {
      const Index own = groups_.group(pair.particles[static_cast<std::size_t>(k)]);
      if (own == kNone) continue;
      inner = inner && (group == kNone || own == group);
      group = own;
    }
    if (group == kNone || !inner) continue;
    const double at_target = heights_at(pair, targets_).gap();
    const double kept = tolerance_.kept(heights_at(pair, before_).gap());
    if (!(at_target < kept)) continue;
    const double at_start =
        heights_of(pair, [&](int k) { return pair.normal.dot(groups_.start(pair.particles[static_cast<std::size_t>(k)])); }).gap();
    groups_.limit_fraction(group, std::clamp((at_start - kept) / (at_start - at_target), 0.0, 1.0));
  }
}

std::vector<DivisionPlanes::Bound> DivisionPlanes::bounds(const std::vector<ContactStencil>& pairs) const {
  std::vector<Bound> found;
  for (const ContactStencil& pair : pairs) {
    if (!pair.any_of([&](Index i) { return groups_.contains(i); })) continue;
    const double begun = heights_at(pair, before_).gap();
    if (!(begun > 0.0)) continue;
    append_bounds(pair, groups_.moved(group_of(pair, begun), pair.normal), found);
  }
  return sorted(found, static_cast<Index>(before_.cols()));
}

void DivisionPlanes::append_bounds(const ContactStencil& pair, const MovedPlane& plane, std::vector<Bound>& found) const {
  append_bounds(pair, plane.end, Vector3::Zero(), found);
  if (plane.is_constant()) return;
  append_bounds(pair, plane.begin, 2.0 * plane.middle, found);
  append_bounds(pair, 2.0 * plane.middle, plane.end, found);
}

/// Bounds `after` . x1 + `earlier` . x0 of each constrained particle, where x0 and x1 are its positions at the step's begin and
/// end.
void DivisionPlanes::append_bounds(const ContactStencil& pair, const Vector3& after, const Vector3& earlier,
                                   std::vector<Bound>& found) const {
  const double length = after.norm();
  const Vector3 normal = after / length;
  const auto extra = [&](Index i) { return earlier.dot(before_.col(i)) / length; };
  const auto heights = [&](const Points& x) {
    return heights_of(pair, [&](int k) {
      const Index i = pair.particles[static_cast<std::size_t>(k)];
      return normal.dot(x.col(i)) + extra(i);
    });
  };
  const double room = 0.5 * tolerance_.kept(heights_at(pair, before_).gap());
  const SideHeights end = heights(ends_);
  const SideHeights target = heights(targets_);
  const double least = 0.5 * std::clamp(end.gap(), 0.0, tolerance_.least());
  const double highest = std::max(end.first, end.second) - least;
  const double middle = std::max(end.second + least, std::min(0.5 * (target.first + target.second), highest));
  const double above = std::min(end.first, middle + room);
  const double below = std::max(end.second, middle - room);
  for (int k = 0; k < pair.count(); ++k) {
    const Index i = pair.particles[static_cast<std::size_t>(k)];
    if (!groups_.contains(i)) continue;
    found.push_back(k < pair.first_count ? Bound{i, {normal, above - extra(i)}} : Bound{i, {-normal, extra(i) - below}});
  }
}

}  // namespace sprung
